#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace s2s::odometry {

/// Residuals may be this much smaller than expected and be believed; much smaller ones come from a map that has been
/// fitted to them.
constexpr double kLeastScale = 0.5;

/// Weight in Cauchy's kernel of a residual with this variance; a width of 2.385 standard deviations keeps 95 %
/// efficiency on Gaussian residuals.
inline double cauchyWeight(double residual, double variance) {
  constexpr double kWidth = 2.385;
  return 1.0 / (1.0 + residual * residual / (kWidth * kWidth * variance));
}

/// Robust standard deviation of residuals given by their sizes (which are put into another order); 0 if there are none.
inline double robustScale(std::vector<double>& sizes) {
  constexpr double kMedianOfAbs = 0.6745;  // of a unit Gaussian
  if (sizes.empty()) return 0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle / kMedianOfAbs;
}

}  // namespace s2s::odometry
