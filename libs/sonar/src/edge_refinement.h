#pragma once

#include <opencv2/core.hpp>

#include "s2s/sonar/leading_edge.h"

namespace s2s::sonar {

/// Takes the delay by speckle out of the ranges of the first returns.
///
/// The first cell of an edge exceeds the threshold by chance only; if it does not, the next one may. So the range found
/// is the edge's plus a delay that is close to exponentially distributed, and grows as the echo gets dimmer. Of the
/// returns around a beam, with their common slope taken out, the quantiles Q25 and Q50 then give the delay's mean
/// (Q50 - Q25) / ln 1.5 and the edge itself, Q25 - ln(4/3) times that. The delay's mean also is what the range is
/// uncertain by. Returns that stand apart, and earlier ones, which are another surface, stay as they are.
void correctSpeckleDelay(double window_rad, LineScan& scan);

/// Adds the brightest ridge behind each beam's first return, and numbers the returns of each beam anew.
///
/// Its range is that of its middle: a beam is wide enough for its flanks to see a strong, inclined surface both nearer
/// and farther, so that its leading edge is early.
void addRidges(const cv::Mat& image, const PingGeometry& geometry, const LeadingEdgeOptions& options, LineScan& scan);

}  // namespace s2s::sonar
