#pragma once

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

}  // namespace s2s::sonar
