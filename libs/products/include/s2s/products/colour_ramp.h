#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace s2s::products {

using Rgb = std::array<std::uint8_t, 3>;

/// A colour for each value of an interval, linear between evenly spaced anchors; values outside take the ends' colour.
class ColourRamp {
 public:
  ColourRamp(double low, double high, std::vector<Rgb> anchors);

  double low() const { return low_; }
  double high() const { return high_; }
  Rgb at(double value) const;

 private:
  double low_, high_;
  std::vector<Rgb> anchors_;
};

/// The two ramps of every picture: heights of LiDAR points in earth and stone colours, heights of sonar points, all
/// below the water surface, from deep blue to a light green. One never takes the other for its own.
struct MapColours {
  ColourRamp lidar;
  ColourRamp sonar;

  /// Intervals are heights in the map frame; empty ones are widened.
  MapColours(double lidarLow_m, double lidarHigh_m, double sonarLow_m, double sonarHigh_m);
};

}  // namespace s2s::products
