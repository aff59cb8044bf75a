#include "s2s/eval/distribution.h"

#include <mrpt/core/exceptions.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace s2s::eval {

double scottBandwidth(const std::vector<double>& values) {
  ASSERT_(values.size() >= 2);
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / (n - 1)) * std::pow(n, -0.2);
}

std::vector<double> gaussianKde(const std::vector<double>& values, double bandwidth, const std::vector<double>& at) {
  ASSERT_(!values.empty() && bandwidth > 0);
  constexpr double kSqrt2Pi = 2.5066282746310002;
  const double scale = 1 / (kSqrt2Pi * bandwidth * static_cast<double>(values.size()));
  std::vector<double> density(at.size(), 0.0);
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (const double v : values) {
      const double u = (at[i] - v) / bandwidth;
      density[i] += std::exp(-0.5 * u * u);
    }
    density[i] *= scale;
  }
  return density;
}

double hellingerDistance(const std::vector<double>& p, const std::vector<double>& q) {
  ASSERT_EQUAL_(p.size(), q.size());
  const double sumP = std::accumulate(p.begin(), p.end(), 0.0);
  const double sumQ = std::accumulate(q.begin(), q.end(), 0.0);
  ASSERT_(sumP > 0 && sumQ > 0);
  double overlap = 0;
  for (std::size_t i = 0; i < p.size(); ++i) overlap += std::sqrt(p[i] / sumP * (q[i] / sumQ));
  return std::sqrt(std::max(0.0, 1 - overlap));
}

std::vector<double> binCentres(double min, double max, int bins) {
  std::vector<double> centres(static_cast<std::size_t>(std::max(bins, 0)));
  for (int i = 0; i < bins; ++i) centres[static_cast<std::size_t>(i)] = min + (i + 0.5) * (max - min) / bins;
  return centres;
}

}  // namespace s2s::eval
