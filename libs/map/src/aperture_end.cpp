#include "s2s/map/aperture_end.h"

#include <algorithm>
#include <cmath>

namespace s2s::map {

namespace {

/// A ping tells with so many returns.
constexpr std::size_t kMinReturns = 5;
/// Ends are counted in bins of this width: a sixtieth of a degree, 1 mm of range at 5 m.
constexpr double kBin_rad = 3e-4;
/// Neighbouring pings meet the same piece of bed and the same evidence of it: so many count as one.
constexpr double kPingsAlike = 10;
/// Standard deviation of a normal distribution by its interquartile range; of its median by that of the mean.
constexpr double kQuartilesToSigma = 1 / 1.349, kMedianToMean = 1.2533;

}  // namespace

ApertureEnd::ApertureEnd(double prior_rad) : prior_rad_(prior_rad), sigma_rad_(prior_rad) {}

void ApertureEnd::addPing(std::vector<double> beyond_rad) {
  if (beyond_rad.size() < kMinReturns) return;
  const auto middle = beyond_rad.begin() + static_cast<std::ptrdiff_t>(beyond_rad.size() / 2);
  std::nth_element(beyond_rad.begin(), middle, beyond_rad.end());
  if (!(std::abs(*middle) < kReach_rad)) return;
  if (histogram_.empty()) histogram_.resize(static_cast<std::size_t>(std::ceil(2 * kReach_rad / kBin_rad)));
  const auto bin = static_cast<std::size_t>((*middle + kReach_rad) / kBin_rad);
  ++histogram_[std::min(bin, histogram_.size() - 1)];
  ++pings_;
  estimate();
}

void ApertureEnd::estimate() {
  const auto quantile = [&](double share) {
    const double target = share * static_cast<double>(pings_);
    double sum = 0;
    for (std::size_t i = 0; i < histogram_.size(); ++i) {
      const double next = sum + histogram_[i];
      if (histogram_[i] > 0 && next >= target)
        return (static_cast<double>(i) + (target - sum) / histogram_[i]) * kBin_rad - kReach_rad;
      sum = next;
    }
    return kReach_rad;
  };
  // One ping alone has no scatter: it counts with the prior's.
  const double alike = 1 + (static_cast<double>(pings_) - 1) / kPingsAlike;
  const double scatter_rad = kQuartilesToSigma * (quantile(0.75) - quantile(0.25));
  const double single2 = (scatter_rad * scatter_rad * (alike - 1) + prior_rad_ * prior_rad_) / alike;
  const double median2 = kMedianToMean * kMedianToMean * single2 / alike;
  const double prior2 = prior_rad_ * prior_rad_, sum2 = prior2 + median2;
  median_rad_ = quantile(0.5);
  trust_ = sum2 > 0 ? prior2 / sum2 : 0;
  sigma_rad_ = std::sqrt(trust_ * median2);
}

}  // namespace s2s::map
