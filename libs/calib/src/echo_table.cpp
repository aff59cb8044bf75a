#include "s2s/calib/echo_table.h"

#include <cmath>

namespace s2s::calib {

namespace {

/// Far edges this near the last bin may be cut off by it.
constexpr double kEndMargin_m = 0.2;

/// A longer band is blurred by noise, and so is its centre.
constexpr double kLongestMiddle_m = 0.25;

/// Up component of the imaging plane's normal: the sine of the plane's angle to the vertical.
double upOf(const core::Isometry& T_vehicle_sonar) { return T_vehicle_sonar.linear()(2, 2); }

float lowerEdge(const core::Isometry& T_vehicle_sonar) { return upOf(T_vehicle_sonar) > 0 ? -1.0F : 1.0F; }

void addBand(const Swath& swath, std::vector<Echo>& echoes) {
  echoes.push_back({static_cast<float>(swath.bearing_rad), static_cast<float>(swath.middle_m), EchoKind::Band,
                    static_cast<float>(1 / std::sqrt(3.0))});
}

void addEdges(const Swath& swath, float lower, double maxRange_m, std::vector<Echo>& echoes) {
  const auto bearing = static_cast<float>(swath.bearing_rad);
  echoes.push_back({bearing, static_cast<float>(swath.near_m), EchoKind::NearEdge, lower});
  if (swath.far_m < maxRange_m - kEndMargin_m)
    echoes.push_back({bearing, static_cast<float>(swath.far_m), EchoKind::FarEdge, -lower});
}

}  // namespace

std::vector<Echo> returnsOf(const sonar::LineScan& scan, const core::Isometry& T_vehicle_sonar, int beamStep) {
  const float lower = lowerEdge(T_vehicle_sonar);
  std::vector<Echo> echoes;
  for (const auto& r : scan.returns) {
    if (r.beam % static_cast<std::uint32_t>(beamStep) != 0) continue;
    const auto bearing = static_cast<float>(r.bearing_rad), range = static_cast<float>(r.range_m);
    if (r.isRidge)
      echoes.push_back({bearing, range, EchoKind::Ridge, 0});
    else if (r.order == 0)
      echoes.push_back({bearing, range, EchoKind::NearEdge, lower});
  }
  return echoes;
}

std::vector<Echo> echoesOf(const std::vector<Swath>& swaths, const core::Isometry& T_vehicle_sonar, double aperture_rad,
                           double maxRange_m) {
  const bool upright = std::abs(upOf(T_vehicle_sonar)) < std::sin(aperture_rad);
  std::vector<Echo> echoes;
  for (const Swath& swath : swaths) {
    if (upright && swath.far_m - swath.near_m > kLongestMiddle_m) continue;
    if (upright)
      addBand(swath, echoes);
    else
      addEdges(swath, lowerEdge(T_vehicle_sonar), maxRange_m, echoes);
  }
  return echoes;
}

}  // namespace s2s::calib
