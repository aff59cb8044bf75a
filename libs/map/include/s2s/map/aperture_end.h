#pragma once

#include <cstddef>
#include <vector>

namespace s2s::map {

/// Where a sonar's aperture ends for its first echoes, as a survey itself tells.
///
/// A bright bed is heard beyond the nominal end of the vertical aperture, of a dim one the last part is not: that
/// depends on bed, beam pattern and detector, and is nearly alike for all pings of a survey. Where a bed that is known
/// from elsewhere is met first at the aperture's end, its range tells the elevation it came from.
///
/// The estimate is the median over pings (each the median of its returns), drawn towards what was known before, such as
/// the nominal end, by how well that was: with few pings it stays near it. It grows ping by ping; memory is constant.
class ApertureEnd {
 public:
  /// @param prior_rad standard deviation of the end about the nominal one, before anything is seen
  explicit ApertureEnd(double prior_rad = 0);

  /// Elevations at which one ping's arcs met the known bed, counted from the nominal end, positive beyond it. Pings
  /// with few of them, and ends further off than `kReach_rad`, do not count.
  void addPing(std::vector<double> beyond_rad);

  /// The end, positive beyond the nominal one; `expected_rad`, what is known otherwise, as long as nothing is seen.
  double beyond_rad(double expected_rad = 0) const { return expected_rad + trust_ * (median_rad_ - expected_rad); }
  /// Standard deviation of `beyond_rad`: that of the median, not of a single ping's end.
  double sigma_rad() const { return sigma_rad_; }
  std::size_t pings() const { return pings_; }

  static constexpr double kReach_rad = 0.07;  // 4 degrees

 private:
  void estimate();

  double prior_rad_;
  std::vector<unsigned> histogram_;  ///< pings by end; empty before the first
  std::size_t pings_ = 0;
  double median_rad_ = 0, trust_ = 0, sigma_rad_;
};

}  // namespace s2s::map
