#pragma once

#include <vector>

namespace s2s::eval {

/// Scott's rule for one dimension, h = s n^(-1/5) with the sample standard deviation s (Scott 1992); SciPy's default.
/// @pre at least two values
double scottBandwidth(const std::vector<double>& values);

/// Gaussian kernel density estimate of `values` at the places `at`; integrates to one over the line.
/// @pre `values` is not empty, `bandwidth` > 0
std::vector<double> gaussianKde(const std::vector<double>& values, double bandwidth, const std::vector<double>& at);

/// Hellinger distance of two densities given at the same equally spaced places, each first scaled to sum one:
/// H = sqrt(1 - sum sqrt(p q)), in [0, 1] (Hellinger 1909).
/// @pre same length, no negative values, positive sums
double hellingerDistance(const std::vector<double>& p, const std::vector<double>& q);

/// Centres of `bins` equal bins between two limits.
std::vector<double> binCentres(double min, double max, int bins);

}  // namespace s2s::eval
