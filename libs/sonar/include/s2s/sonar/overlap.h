#pragma once

#include <vector>

#include "s2s/core/transform.h"
#include "s2s/sonar/cfar.h"
#include "s2s/sonar/ping_geometry.h"

namespace s2s::sonar {

/// True if a point in a sonar's frame is within its fan, its aperture and its range.
bool isInView(const PingGeometry& geometry, const Eigen::Vector3d& p_sonar);

/// The part of one sonar's image whose arcs meet the other sonar's view.
struct Overlap {
  ImageRegion region;                     ///< the smallest rectangle that holds all of it
  std::vector<std::pair<int, int>> bins;  ///< for each beam of the image the bins [first, end); empty if first == end
  bool contains(int beam, int bin) const {
    const auto& interval = bins[static_cast<std::size_t>(beam)];
    return bin >= interval.first && bin < interval.second;
  }
};

/// Trims sonar a's image to what sonar b can see, for any placement of the two: a pixel is kept if a point of its arc
/// over a's aperture is in b's view. Checked on a grid of about 1 degree and 0.2 m and widened by one grid step, so
/// nothing in the overlap is lost.
Overlap findOverlap(const PingGeometry& a, const PingGeometry& b, const core::Isometry& T_b_a);

}  // namespace s2s::sonar
