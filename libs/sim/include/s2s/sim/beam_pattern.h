#pragma once

namespace s2s::sim {

/// Amplitude pattern of a line array shaded by a raised cosine on a pedestal, over x = D/lambda sin(angle), one at
/// x = 0: the transform of w(s) = taper + (1 - taper) cos(2 pi s) on [-1/2, 1/2] (Harris 1978).
double arrayPattern(double x, double taper);

/// The x at which the power of `arrayPattern` has fallen to one half.
double halfPowerPoint(double taper);

}  // namespace s2s::sim
