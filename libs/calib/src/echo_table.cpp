#include "s2s/calib/echo_table.h"

#include <cmath>

namespace s2s::calib {

namespace {

/// Far edges this near the last bin may be cut off by it.
constexpr double kEndMargin_m = 0.2;

/// A longer band is blurred by noise, and so is its centre.
constexpr double kLongestMiddle_m = 0.25;

void addMiddle(const Swath& swath, bool upper, std::vector<Echo>& echoes) {
  const double share = (upper ? 1 : -1) / std::sqrt(3.0);
  echoes.push_back({static_cast<float>(swath.bearing_rad), static_cast<float>(swath.middle_m), EchoKind::Middle,
                    static_cast<float>(share)});
}

void addEdges(const Swath& swath, float lower, double maxRange_m, std::vector<Echo>& echoes) {
  const auto bearing = static_cast<float>(swath.bearing_rad);
  echoes.push_back({bearing, static_cast<float>(swath.near_m), EchoKind::NearEdge, lower});
  if (swath.far_m < maxRange_m - kEndMargin_m)
    echoes.push_back({bearing, static_cast<float>(swath.far_m), EchoKind::FarEdge, -lower});
}

}  // namespace

std::vector<Echo> echoesOf(const std::vector<Swath>& swaths, const core::Isometry& T_vehicle_sonar, double aperture_rad,
                           double maxRange_m) {
  // Up component of the imaging plane's normal: the sine of the plane's angle to the vertical.
  const double up = T_vehicle_sonar.linear()(2, 2);
  const bool upright = std::abs(up) < std::sin(aperture_rad);
  std::vector<Echo> echoes;
  bool upper = false;
  for (const Swath& swath : swaths) {
    if (upright && swath.far_m - swath.near_m > kLongestMiddle_m) continue;
    if (upright)
      addMiddle(swath, upper = !upper, echoes);
    else
      addEdges(swath, up > 0 ? -1.0F : 1.0F, maxRange_m, echoes);
  }
  return echoes;
}

}  // namespace s2s::calib
