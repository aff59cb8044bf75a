#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "s2s/calib/echo_table.h"
#include "s2s/calib/sonar_parameters.h"

namespace s2s::calib {

/// Where the vehicle was at a ping and how it moved, for the nominal time offset of this round.
struct PingMotion {
  core::Isometry T_map_vehicle = core::Isometry::Identity();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< in the vehicle's frame
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();    ///< in the vehicle's frame
  double timeOffset_s = 0;                                 ///< correction kTime at which the pose was taken
};

/// R = exp(w), applied to p; also for Ceres' jets, and smooth at w = 0.
template <class T>
Eigen::Matrix<T, 3, 1> rotate(const Eigen::Matrix<T, 3, 1>& w, const Eigen::Matrix<T, 3, 1>& p) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T angle2 = w.squaredNorm();
  const Eigen::Matrix<T, 3, 1> wp = w.cross(p);
  if (angle2 < T(1e-12)) return p + wp + T(0.5) * w.cross(wp);
  const T angle = sqrt(angle2);
  return p + (sin(angle) / angle) * wp + ((T(1) - cos(angle)) / angle2) * w.cross(wp);
}

/// Range and sine of the bearing as they would be without the errors that are estimated.
///
/// A device that believes c_d in water of c scales ranges by c_d / c and steers by delays, so
///   r = r_measured c / c_d - range error,   sin b = sin b_measured c / c_d.
template <class T>
struct CorrectedBeam {
  T range_m, sinBearing;
  CorrectedBeam(double range, double bearing, const SonarState& sonar, const T* const correction,
                const T& soundSpeed_mps) {
    const T ratio = soundSpeed_mps / T(sonar.deviceSoundSpeed_mps);
    range_m = T(range) * ratio - (correction[kRange] + correction[kScale] * range + correction[kRangeTilt] * bearing +
                                  correction[kRangeBend] * (bearing * bearing));
    sinBearing = T(std::sin(bearing)) * ratio;
  }
};

/// The point of a beam at an elevation, in the sonar's frame.
template <class T>
Eigen::Matrix<T, 3, 1> beamPoint(const CorrectedBeam<T>& beam, const T& elevation, obs::BearingModel model) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  using Vector = Eigen::Matrix<T, 3, 1>;
  const T sinE = sin(elevation), cosE = cos(elevation), sinB = beam.sinBearing;
  if (model == obs::BearingModel::Azimuth)
    return Vector(cosE * sqrt(T(1) - sinB * sinB), cosE * sinB, sinE) * beam.range_m;
  return Vector(sqrt(T(1) - sinB * sinB - sinE * sinE), sinB, sinE) * beam.range_m;
}

/// From a sonar's frame to the vehicle's, with the correction of the mounting.
template <class T>
Eigen::Matrix<T, 3, 1> toVehicle(const Eigen::Matrix<T, 3, 1>& p_sonar, const SonarState& sonar,
                                 const T* const correction) {
  using Vector = Eigen::Matrix<T, 3, 1>;
  const Vector turned = rotate<T>(Vector(correction[kRotX], correction[kRotY], correction[kRotZ]), p_sonar);
  return sonar.T_vehicle_sonar.linear().template cast<T>() * turned +
         sonar.T_vehicle_sonar.translation().template cast<T>() +
         Vector(correction[kX], correction[kY], correction[kZ]);
}

/// From the vehicle's frame to the map's. To first order the vehicle at another time offset has moved on by (kTime -
/// timeOffset) seconds less of its motion.
template <class T>
Eigen::Matrix<T, 3, 1> toMap(const Eigen::Matrix<T, 3, 1>& p_vehicle, const PingMotion& motion,
                             const T* const correction) {
  const T later = T(motion.timeOffset_s) - correction[kTime];
  const Eigen::Matrix<T, 3, 1> moved =
      motion.velocity_mps.template cast<T>() + motion.rate_radps.template cast<T>().cross(p_vehicle);
  const Eigen::Matrix<T, 3, 1> p_then = p_vehicle + moved * later;
  return motion.T_map_vehicle.linear().template cast<T>() * p_then +
         motion.T_map_vehicle.translation().template cast<T>();
}

/// What holds of a sonar's corrections for evidence that has no part in how edges and bands of single pings are found:
/// the mounting, and the nuisances that are its own.
template <class T, std::size_t N>
std::array<T, kSonarParameters> ownCorrection(const T* const correction,
                                              const std::array<SonarParameter, N>& nuisances) {
  std::array<T, kSonarParameters> own;
  own.fill(T(0));
  std::copy_n(correction, kWantedSonarParameters, own.begin());
  for (const SonarParameter i : nuisances) own[static_cast<std::size_t>(i)] = correction[i];
  return own;
}

/// Where the end of the aperture at a place of the fan meets the bed.
template <class T>
Eigen::Matrix<T, 3, 1> apertureEndPoint(const Echo& echo, const SonarState& sonar, const PingMotion& motion,
                                        const T* const correction, const T& soundSpeed_mps) {
  const auto own = ownCorrection<T, 3>(correction, {kWidth, kWidthBend, kAxis});
  const auto bearing = static_cast<double>(echo.bearing_rad);
  const CorrectedBeam<T> beam(echo.range_m, bearing, sonar, own.data(), soundSpeed_mps);
  const T half = T(0.5 * sonar.aperture_rad) + own[kWidth] + own[kWidthBend] * (bearing * bearing);
  const T elevation = T(echo.elevationShare) * half + own[kAxis];
  return toMap<T>(toVehicle<T>(beamPoint<T>(beam, elevation, sonar.model), sonar, own.data()), motion, own.data());
}

/// The place in the map of an echo: the beam at the elevation of the echo's kind, mounting, time.
template <class T>
Eigen::Matrix<T, 3, 1> echoPoint(const Echo& echo, const SonarState& sonar, const PingMotion& motion,
                                 const T* const correction, const T& soundSpeed_mps) {
  if (echo.kind == EchoKind::ApertureEnd) return apertureEndPoint(echo, sonar, motion, correction, soundSpeed_mps);
  const auto bearing = static_cast<double>(echo.bearing_rad);
  const CorrectedBeam<T> beam(echo.range_m, bearing, sonar, correction, soundSpeed_mps);
  T beyond(0);
  if (echo.kind == EchoKind::NearEdge) beyond = correction[kNear] + correction[kNearBend] * (bearing * bearing);
  if (echo.kind == EchoKind::FarEdge) beyond = correction[kFar] + correction[kFarBend] * (bearing * bearing);
  T elevation = T(echo.elevationShare) * (T(0.5 * sonar.aperture_rad) + beyond);
  if (echo.kind == EchoKind::Middle || echo.kind == EchoKind::Band)
    elevation += correction[kNear] + correction[kNearBend] * bearing;
  return toMap<T>(toVehicle<T>(beamPoint<T>(beam, elevation, sonar.model), sonar, correction), motion, correction);
}

/// Height of a bilinear surface above the place (x, y) of a cell.
template <class T>
T bilinear(const T& x, const T& y, const Eigen::Vector2d& corner_m, double cell_m, const T* const h00,
           const T* const h10, const T* const h01, const T* const h11) {
  const T u = (x - T(corner_m.x())) / T(cell_m), v = (y - T(corner_m.y())) / T(cell_m);
  return (T(1) - u) * (T(1) - v) * *h00 + u * (T(1) - v) * *h10 + (T(1) - u) * v * *h01 + u * v * *h11;
}

/// How far an echo's point lies above a seabed given by heights at the four corners of a grid cell, in standard
/// deviations. For ceres::AutoDiffCostFunction<SeabedResidual, 1, kSonarParameters, 1, 1, 1, 1, 1>.
struct SeabedResidual {
  Echo echo;
  const SonarState* sonar = nullptr;
  const PingMotion* motion = nullptr;
  Eigen::Vector2d corner_m;  ///< lower corner of the cell, map frame
  double cell_m = 1;
  double weight_perM = 1;  ///< of a metre of height

  template <class T>
  bool operator()(const T* const correction, const T* const soundSpeed, const T* const h00, const T* const h10,
                  const T* const h01, const T* const h11, T* residual) const {
    const auto p = echoPoint<T>(echo, *sonar, *motion, correction, *soundSpeed);
    residual[0] = (p.z() - bilinear<T>(p.x(), p.y(), corner_m, cell_m, h00, h10, h01, h11)) * T(weight_perM);
    return true;
  }
};

/// The other one of the two points that stand for a band.
inline Echo otherPoint(Echo band) {
  band.elevationShare = -band.elevationShare;
  return band;
}

/// How far the two points of a band lie above the bed on average, in standard deviations; each has its own cell.
/// For ceres::AutoDiffCostFunction<BandResidual, 1, kSonarParameters, 1, 1, 1, 1, 1, 1, 1, 1, 1>.
struct BandResidual {
  SeabedResidual one;
  Eigen::Vector2d otherCorner_m;  ///< lower corner of the other point's cell

  template <class T>
  bool operator()(const T* const correction, const T* const soundSpeed, const T* const a00, const T* const a10,
                  const T* const a01, const T* const a11, const T* const b00, const T* const b10, const T* const b01,
                  const T* const b11, T* residual) const {
    SeabedResidual other = one;
    other.echo = otherPoint(one.echo);
    other.corner_m = otherCorner_m;
    T gap, otherGap;
    one(correction, soundSpeed, a00, a10, a01, a11, &gap);
    other(correction, soundSpeed, b00, b10, b01, b11, &otherGap);
    residual[0] = T(0.5) * (gap + otherGap);
    return true;
  }
};

}  // namespace s2s::calib
