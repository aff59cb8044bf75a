#include "s2s/eval/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace s2s::eval {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double meanSquareAbout(const std::vector<double>& values, double centre) {
  double sum = 0;
  for (const double v : values) sum += (v - centre) * (v - centre);
  return sum / static_cast<double>(values.size());
}

/// A denominator or numerator of Lentz's method, kept away from zero.
double awayFromZero(double value) {
  constexpr double kTiny = 1e-300;
  return std::abs(value) < kTiny ? kTiny : value;
}

/// Continued fraction of the incomplete beta function (A&S 26.5.8) by Lentz's method; converges fast for
/// x < (a + 1) / (a + b + 2).
double betaFraction(double a, double b, double x) {
  double c = 1, d = 1 / awayFromZero(1 - (a + b) * x / (a + 1)), fraction = d;
  for (int m = 1; m <= 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1;
    for (const double coefficient : {even, odd}) {
      d = 1 / awayFromZero(1 + coefficient * d);
      c = awayFromZero(1 + coefficient / c);
      step = c * d;
      fraction *= step;
    }
    if (std::abs(step - 1) < 1e-16) break;
  }
  return fraction;
}

/// I_x(a, b).
double regularisedBeta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * betaFraction(a, b, x) / a;
  return 1 - front * betaFraction(b, a, 1 - x) / b;
}

}  // namespace

Summary summarise(std::vector<double> values) {
  Summary s;
  s.count = values.size();
  if (values.empty()) return s;
  std::sort(values.begin(), values.end());
  s.mean = mean(values);
  s.median = percentile(values, 0.5);
  s.rmse = std::sqrt(meanSquareAbout(values, 0));
  s.std = std::sqrt(meanSquareAbout(values, s.mean));
  s.min = values.front();
  s.max = values.back();
  s.p95 = percentile(values, 0.95);
  return s;
}

double percentile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return kNaN;
  const double position = std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double shareWithin(const std::vector<double>& values, double limit) {
  if (values.empty()) return 0;
  const auto inside = std::count_if(values.begin(), values.end(), [&](double v) { return std::abs(v) <= limit; });
  return static_cast<double>(inside) / static_cast<double>(values.size());
}

MeanInterval meanInterval95(const std::vector<double>& values) {
  if (values.empty()) return {kNaN, kNaN};
  const double centre = mean(values);
  if (values.size() < 2) return {centre, kNaN};
  const auto n = static_cast<double>(values.size());
  const double sampleVariance = meanSquareAbout(values, centre) * n / (n - 1);
  return {centre, studentTQuantile(0.975, n - 1) * std::sqrt(sampleVariance / n)};
}

double studentTCdf(double t, double dof) {
  const double tail = 0.5 * regularisedBeta(0.5 * dof, 0.5, dof / (dof + t * t));
  return t > 0 ? 1 - tail : tail;
}

double studentTQuantile(double probability, double dof) {
  if (probability < 0.5) return -studentTQuantile(1 - probability, dof);
  double low = 0, high = 1;
  while (studentTCdf(high, dof) < probability) high *= 2;
  // The function is monotonic, so halving the bracket is certain to end at the resolution of a double.
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (studentTCdf(middle, dof) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace s2s::eval
