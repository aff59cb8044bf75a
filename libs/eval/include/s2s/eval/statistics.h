#pragma once

#include <cstddef>
#include <vector>

namespace s2s::eval {

/// What a set of errors says in a few numbers, all in the unit of the values. Zero throughout for an empty set.
struct Summary {
  std::size_t count = 0;
  double mean = 0;
  double median = 0;
  double rmse = 0;  ///< root of the mean square about zero
  double std = 0;   ///< root of the mean square about the mean (population form, as evo)
  double min = 0;
  double max = 0;
  double p95 = 0;  ///< 95th percentile
};

Summary summarise(std::vector<double> values);

/// The value below which `share` in [0, 1] of the sorted values lie, linear between order statistics (type 7 of
/// Hyndman & Fan 1996, the default of R and NumPy). NaN for no values.
double percentile(const std::vector<double>& sorted, double share);

/// Share in [0, 1] of the values whose magnitude is at most `limit`; 0 for no values.
double shareWithin(const std::vector<double>& values, double limit);

/// Mean and the half width of its two-sided 95 % confidence interval by Student's t with n - 1 degrees of freedom.
struct MeanInterval {
  double mean = 0;
  double halfWidth = 0;  ///< NaN for fewer than two values
};
MeanInterval meanInterval95(const std::vector<double>& values);

/// Cumulative distribution function of Student's t, by the regularised incomplete beta function
/// (Abramowitz & Stegun 26.7.1, 26.5.8).
/// @pre `dof` > 0
double studentTCdf(double t, double dof);

/// Its inverse.
/// @pre 0 < `probability` < 1, `dof` > 0
double studentTQuantile(double probability, double dof);

}  // namespace s2s::eval
