#include "s2s/map/sonar_scans.h"

#include <algorithm>
#include <cmath>

namespace s2s::map {

namespace {

/// Cosine of the pitch below which a roll is not defined well enough: 3 degrees off straight down.
constexpr double kStraightDown = 0.05;

}  // namespace

LineScan toMapLineScan(const sonar::LineScan& leadingEdge, const core::Isometry& T_vehicle_sonar) {
  LineScan scan;
  scan.T_vehicle_sonar = T_vehicle_sonar;
  scan.verticalAperture_rad = leadingEdge.verticalAperture_rad;
  scan.bearingModel = leadingEdge.bearingModel;
  scan.bearingSigma_rad = leadingEdge.bearingSigma_rad;
  scan.returns.reserve(leadingEdge.returns.size());
  for (const sonar::LineReturn& r : leadingEdge.returns)
    scan.returns.push_back({static_cast<float>(r.range_m), static_cast<float>(r.bearing_rad), r.intensity,
                            static_cast<float>(r.rangeSigma_m), std::min<std::uint8_t>(r.order, kMaxOrder), r.isRidge});
  return scan;
}

std::vector<ScanPoint> toScanPoints(const std::vector<sonar::StereoPoint>& points,
                                    const core::Isometry& T_vehicle_horizontal) {
  std::vector<ScanPoint> out;
  out.reserve(points.size());
  for (const sonar::StereoPoint& point : points)
    out.push_back(
        {(T_vehicle_horizontal * point.p_h).cast<float>(), point.intensity, static_cast<float>(point.sigma_m())});
  return out;
}

bool isVerticalSonar(const core::Isometry& T_vehicle_sonar) {
  // Up components of the fan's axis across the beam and of its normal: cos(pitch) times sine and cosine of the roll.
  const Eigen::Matrix3d R = T_vehicle_sonar.linear();
  const double across = std::abs(R(2, 1)), normal = std::abs(R(2, 2));
  if (std::hypot(across, normal) > kStraightDown) return across > normal;
  return std::abs(R(1, 1)) < std::sqrt(0.5);
}

}  // namespace s2s::map
