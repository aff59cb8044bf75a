#include "s2s/products/colour_ramp.h"

#include <algorithm>
#include <cmath>

namespace s2s::products {

ColourRamp::ColourRamp(double low, double high, std::vector<Rgb> anchors)
    : low_(low), high_(std::max(high, low + 0.1)), anchors_(std::move(anchors)) {}

Rgb ColourRamp::at(double value) const {
  const double last = static_cast<double>(anchors_.size() - 1);
  const double place = std::isnan(value) ? 0 : std::clamp((value - low_) / (high_ - low_), 0.0, 1.0) * last;
  const auto i = std::min(static_cast<std::size_t>(place), anchors_.size() - 2);
  const double u = place - static_cast<double>(i);
  Rgb colour{};
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<std::uint8_t>(std::lround((1 - u) * anchors_[i][c] + u * anchors_[i + 1][c]));
  return colour;
}

MapColours::MapColours(double lidarLow_m, double lidarHigh_m, double sonarLow_m, double sonarHigh_m)
    : lidar(lidarLow_m, lidarHigh_m,
            {{{104, 74, 58}}, {{150, 96, 60}}, {{186, 122, 62}}, {{222, 164, 76}}, {{240, 202, 112}}}),
      sonar(sonarLow_m, sonarHigh_m,
            {{{40, 44, 126}}, {{36, 92, 172}}, {{32, 144, 184}}, {{70, 190, 170}}, {{160, 222, 150}}}) {}

}  // namespace s2s::products
