#pragma once

#include <array>

#include "s2s/calib/surface_residual.h"

namespace s2s::calib {

/// The bed around a place, as it was when pictures were laid on it: a plane, whose height follows four nodes.
struct BedPatch {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double height_m = 0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  std::array<double, 4> nodes_m{};  ///< the nodes' heights at that time
};

template <class T>
using SonarCorrection = std::array<T, kSonarParameters>;

/// Where a beam of one ping shows a place of the bed.
struct BedSight {
  Echo echo;                 ///< only bearing and range count
  double elevation_rad = 0;  ///< at which it met the bed
  double rise_mPerRad = 1;   ///< of its height over the bed, with elevation
  const PingMotion* motion = nullptr;
};

/// What holds for texture of a sonar's corrections.
template <class T>
SonarCorrection<T> textureCorrection(const T* const correction) {
  return ownCorrection<T, 1>(correction, {kTextureTilt});
}

/// The place on the bed that a sight shows: its elevation follows from the bed's height.
template <class T>
Eigen::Matrix<T, 3, 1> sightPoint(const BedSight& sight, const SonarState& sonar, const T* const correction,
                                  const T& soundSpeed_mps, const BedPatch& bed, const T& raised_m) {
  const CorrectedBeam<T> beam(sight.echo.range_m, static_cast<double>(sight.echo.bearing_rad), sonar, correction,
                              soundSpeed_mps);
  T elevation(sight.elevation_rad);
  Eigen::Matrix<T, 3, 1> p;
  for (int step = 0; step < 3; ++step) {  // Newton with a constant slope; the last round only places
    p = toMap<T>(toVehicle<T>(beamPoint<T>(beam, elevation, sonar.model), sonar, correction), *sight.motion,
                 correction);
    const T bed_m = T(bed.height_m) + raised_m + correction[kTextureTilt] * elevation +
                    T(bed.slope.x()) * (p.x() - T(bed.centre_m.x())) + T(bed.slope.y()) * (p.y() - T(bed.centre_m.y()));
    if (step < 2) elevation -= (p.z() - bed_m) / T(sight.rise_mPerRad);
  }
  return p;
}

/// How far apart two pings see the same piece of the bed, in standard deviations.
/// For ceres::AutoDiffCostFunction<TextureResidual, 2, kSonarParameters, 1, 1, 1, 1, 1>.
struct TextureResidual {
  BedSight first, second;
  BedPatch bed;
  const SonarState* sonar = nullptr;
  double weight_perM = 1;

  template <class T>
  bool operator()(const T* const correction, const T* const soundSpeed, const T* const h0, const T* const h1,
                  const T* const h2, const T* const h3, T* residual) const {
    const auto& was = bed.nodes_m;
    const T raised = T(0.25) * (*h0 + *h1 + *h2 + *h3 - T(was[0] + was[1] + was[2] + was[3]));
    const SonarCorrection<T> own = textureCorrection(correction);
    const auto a = sightPoint<T>(first, *sonar, own.data(), *soundSpeed, bed, raised);
    const auto b = sightPoint<T>(second, *sonar, own.data(), *soundSpeed, bed, raised);
    residual[0] = (a.x() - b.x()) * T(weight_perM);
    residual[1] = (a.y() - b.y()) * T(weight_perM);
    return true;
  }
};

}  // namespace s2s::calib
