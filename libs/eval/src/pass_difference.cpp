#include "s2s/eval/pass_difference.h"

#include <cmath>
#include <vector>

namespace s2s::eval {

namespace {

constexpr double kSlot_s = 10;

}  // namespace

void PassComparison::add(const Eigen::Vector3d& p, double time_s) {
  const auto height_m = grid_.heightAt(p.x(), p.y());
  if (!height_m || !(std::abs(p.z() - *height_m) <= options_.window_m)) return;
  const int column = static_cast<int>(std::floor((p.x() - grid_.west_m) / grid_.cell_m));
  const int row = static_cast<int>(std::floor((p.y() - grid_.south_m) / grid_.cell_m));
  Slot& slot = cells_[grid_.index(column, row)][static_cast<std::int64_t>(std::floor(time_s / kSlot_s))];
  ++slot.count;
  slot.sum_m += p.z();
}

std::vector<double> PassComparison::passHeights(const Slots& slots) const {
  std::vector<double> heights_m;
  Slot pass;
  std::int64_t last = 0;
  const auto close = [&] {
    if (pass.count >= static_cast<std::uint32_t>(options_.minPoints)) heights_m.push_back(pass.sum_m / pass.count);
    pass = {};
  };
  for (const auto& [number, slot] : slots) {
    if (pass.count > 0 && kSlot_s * static_cast<double>(number - last - 1) >= options_.gap_s) close();
    pass.count += slot.count;
    pass.sum_m += slot.sum_m;
    last = number;
  }
  close();
  return heights_m;
}

PassDifference PassComparison::result() const {
  PassDifference result;
  std::vector<double> differences_m, magnitudes_m;
  for (const auto& [cell, slots] : cells_) {
    const std::vector<double> heights_m = passHeights(slots);
    if (heights_m.size() > 1) ++result.cells;
    for (std::size_t i = 1; i < heights_m.size(); ++i) {
      differences_m.push_back(heights_m[i] - heights_m[i - 1]);
      magnitudes_m.push_back(std::abs(differences_m.back()));
    }
  }
  result.differences = differences_m.size();
  const Summary plain = summarise(std::move(differences_m)), absolute = summarise(std::move(magnitudes_m));
  result.mean_m = plain.mean;
  result.std_m = plain.std;
  result.p95_m = absolute.p95;
  return result;
}

}  // namespace s2s::eval
