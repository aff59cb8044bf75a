#include "s2s/calib/water_mirror.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "s2s/sonar/ping_geometry.h"

namespace s2s::calib {

namespace {

constexpr double kBin_m = 0.01;
constexpr int kBefore = 30, kSamples = 160;  // bins before the return, and altogether
constexpr int kGaps = 100;                   // largest gap, in bins
constexpr int kFirst = 10;                   // bins of the first echo that set the unit
constexpr double kInFront_m = 0.5;     // a mirrored way this near to the edge of what is in front is partly cut off
constexpr double kMinDepth_m = 1;      // nearer to the surface both echoes are one
constexpr double kMinContrast = 20;    // of the first echo over its row's floor, in counts
constexpr double kMaxPoseGap_s = 0.5;  // of the trajectory
constexpr double kRidge = 1;           // traces: bins that no trace reaches stay at zero

/// Echo power goes with a power of the sample; its square is taken, which neither lets a glint nor noise decide.
double square(double value) { return value * value; }

float floorOfRow(const obs::CObservationImagingSonar& ping, std::size_t bin, std::vector<float>& row) {
  for (std::size_t b = 0; b < ping.beamCount; ++b) row[b] = static_cast<float>(ping.sample(bin, b));
  const auto low = row.begin() + static_cast<std::ptrdiff_t>(row.size() / 10);
  std::nth_element(row.begin(), low, row.end());
  return *low;
}

/// Mean traces by expected gap.
struct Stack {
  std::vector<Eigen::VectorXd> mean = std::vector<Eigen::VectorXd>(kGaps, Eigen::VectorXd::Zero(kSamples));
  std::vector<double> count = std::vector<double>(kGaps, 0);
  double perMetre = 0;  ///< mean change of the gap by the sonar's height
  std::size_t traces = 0;
};

/// What is left over by the best shape of echo for a second echo of a strength, off its place by `delta` bins.
double costOf(const Stack& stack, double delta, double strength) {
  Eigen::MatrixXd A = kRidge * Eigen::MatrixXd::Identity(kSamples, kSamples);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(kSamples);
  double squares = 0;
  for (int gap = 0; gap < kGaps; ++gap) {
    const double n = stack.count[static_cast<std::size_t>(gap)];
    if (n == 0) continue;
    const Eigen::VectorXd& S = stack.mean[static_cast<std::size_t>(gap)];
    squares += n * S.squaredNorm();
    const double shift = gap + delta;
    const int whole = static_cast<int>(std::floor(shift));
    const double part = shift - whole;
    for (int j = 0; j < kSamples; ++j) {
      const int from[3] = {j, j - whole, j - whole - 1};
      const double share[3] = {1, strength * (1 - part), strength * part};
      for (int p = 0; p < 3; ++p) {
        if (from[p] < 0 || from[p] >= kSamples) continue;
        y[from[p]] += n * share[p] * S[j];
        for (int q = 0; q < 3; ++q)
          if (from[q] >= 0 && from[q] < kSamples) A(from[p], from[q]) += n * share[p] * share[q];
      }
    }
  }
  return squares - y.dot(A.llt().solve(y));
}

struct Best {
  double delta = 0, strength = 0, cost = 0;
};

/// The best strength for a place, in coarse steps.
Best bestStrength(const Stack& stack, double delta) {
  constexpr double kStep = 0.05;
  std::vector<double> costs;
  for (int k = 0; k <= 10; ++k) {
    costs.push_back(costOf(stack, delta, k * kStep));
    if (k > 1 && costs[static_cast<std::size_t>(k)] > costs[static_cast<std::size_t>(k - 1)]) break;
  }
  const auto least = static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  return {delta, static_cast<double>(least) * kStep, costs[least]};
}

Best bestPlace(const Stack& stack, double reach_bins) {
  std::vector<Best> tried;
  const int reach = static_cast<int>(std::lround(reach_bins));
  for (int delta = -reach; delta <= reach; ++delta) tried.push_back(bestStrength(stack, delta));
  const auto least = static_cast<std::size_t>(
      std::min_element(tried.begin(), tried.end(), [](const Best& a, const Best& b) { return a.cost < b.cost; }) -
      tried.begin());
  Best best = tried[least];
  if (least == 0 || least + 1 == tried.size()) return {};  // it may lie further out
  const double before = costOf(stack, best.delta - 1, best.strength),
               after = costOf(stack, best.delta + 1, best.strength);
  const double curvature = before - 2 * best.cost + after;
  if (curvature > 0) best.delta += std::clamp(0.5 * (before - after) / curvature, -1.0, 1.0);
  return best;
}

/// Gap between the first echo and that by way of the surface, and its change by the sonar's height; nothing if the
/// mirrored way is not well in front of the transducer.
struct Gap {
  double gap_m, perMetre;
};
std::optional<Gap> expectedGap(const core::Isometry& T_map_sonar, double range_m, double bearing_rad,
                               obs::BearingModel model, double waterHeight_m) {
  const Eigen::Vector3d p_map = T_map_sonar * sonar::pointAt({range_m, bearing_rad, 0}, model);
  const double ahead_m = (p_map - T_map_sonar.translation()).head<2>().norm();
  const double up_m = (waterHeight_m - p_map.z()) + (waterHeight_m - T_map_sonar.translation().z());
  if (ahead_m < up_m + kInFront_m || waterHeight_m - p_map.z() < kMinDepth_m) return {};
  const double mirrored_m = std::hypot(ahead_m, up_m);
  // Raising the sonar raises the surface with it, whose place in the sonar's frame is measured: up falls by twice that.
  return Gap{0.5 * (mirrored_m - range_m), -up_m / mirrored_m};
}

}  // namespace

std::vector<MirrorTrace> mirrorTraces(const obs::CObservationImagingSonar& ping, const sonar::LineScan& scan,
                                      const core::Isometry& T_vehicle_sonar, const WaterMirrorOptions& options) {
  std::vector<MirrorTrace> traces;
  std::vector<float> floors, row(ping.beamCount);
  for (const auto& r : scan.returns) {
    if (r.order != 0 || r.isRidge || r.beam % static_cast<std::uint32_t>(options.beamStep) != 0) continue;
    const Eigen::Vector3d ray = T_vehicle_sonar.linear() * sonar::pointAt({1, r.bearing_rad, 0}, ping.bearingModel);
    if (-ray.z() > ray.head<2>().norm() || r.range_m + (kSamples - kBefore) * kBin_m > ping.maxRange_m()) continue;
    if (floors.empty())
      for (std::size_t bin = 0; bin < ping.rangeCount; ++bin) floors.push_back(floorOfRow(ping, bin, row));
    MirrorTrace trace{
        core::fromMrptTime(ping.timestamp), static_cast<float>(r.bearing_rad), static_cast<float>(r.range_m), {}};
    const auto strength = [&](std::size_t bin) {
      return square(ping.sample(bin, r.beam)) - square(static_cast<double>(floors[bin]));
    };
    double first = 0;
    for (int j = 0; j < kSamples; ++j) {
      const double at_m = r.range_m + (j - kBefore) * kBin_m;
      const double bin = (at_m - ping.rangeOffset_m) / ping.rangeResolution_m - 0.5;
      const auto lower = static_cast<std::size_t>(std::max(0.0, bin));
      if (lower + 1 >= ping.rangeCount) break;
      const double part = std::clamp(bin - static_cast<double>(lower), 0.0, 1.0);
      trace.strength.push_back(static_cast<float>((1 - part) * strength(lower) + part * strength(lower + 1)));
      if (j >= kBefore && j < kBefore + kFirst) first += trace.strength.back() / kFirst;
    }
    if (trace.strength.size() != kSamples || first < square(kMinContrast)) continue;
    for (float& value : trace.strength) value /= static_cast<float>(first);
    traces.push_back(std::move(trace));
  }
  return traces;
}

std::optional<MirrorDepth> mirrorDepth(const std::vector<MirrorTrace>& traces, const SonarState& sonar,
                                       double soundSpeed_mps, const core::Trajectory& T_map_vehicle,
                                       double waterHeight_m, const WaterMirrorOptions& options) {
  if (!options.enabled) return {};
  Stack stack;
  const double ratio = soundSpeed_mps / sonar.deviceSoundSpeed_mps;
  const core::Isometry T_vehicle_sonar = sonar.corrected();
  for (const MirrorTrace& trace : traces) {
    const auto T = T_map_vehicle.at(trace.time - core::durationNs(sonar.correctedTimeOffset_s()), kMaxPoseGap_s);
    if (!T) continue;
    const auto gap =
        expectedGap(*T * T_vehicle_sonar, ratio * trace.range_m, trace.bearing_rad, sonar.model, waterHeight_m);
    if (!gap) continue;
    const auto bin = static_cast<std::size_t>(std::lround(gap->gap_m / kBin_m));
    if (bin >= kGaps) continue;
    stack.mean[bin] += Eigen::Map<const Eigen::VectorXf>(trace.strength.data(), kSamples).cast<double>();
    ++stack.count[bin];
    stack.perMetre += gap->perMetre;
    ++stack.traces;
  }
  if (stack.traces < static_cast<std::size_t>(options.minTraces)) return {};
  stack.perMetre /= static_cast<double>(stack.traces);
  for (std::size_t g = 0; g < kGaps; ++g)
    if (stack.count[g] > 0) stack.mean[g] /= stack.count[g];
  const double alone = costOf(stack, 0, 0);
  const Best best = bestPlace(stack, options.reach_m / kBin_m);
  MirrorDepth found;
  found.strength = best.strength;
  found.explained = 1 - best.cost / alone;
  found.traces = stack.traces;
  found.higher_m = best.delta * kBin_m / stack.perMetre;
  if (best.strength < options.minStrength || found.explained < options.minExplained) return {};
  return found;
}

}  // namespace s2s::calib
