#include "s2s/graph/gnss_guest.h"

#include <algorithm>

namespace s2s::graph {

namespace {

/// Fixes and the map's view of the same places, with standard deviations that include the map's own drift.
struct Pairs {
  std::vector<Eigen::Vector3d> map, enu, sigma_m;
};

Pairs makePairs(const std::vector<TiedFix>& fixes, const std::vector<Keyframe>& keyframes, const GnssOptions& options) {
  Pairs pairs;
  std::vector<double> travelled_m;
  for (const auto& tied : fixes) {
    pairs.map.push_back(keyframes[tied.keyframe].T_map_vehicle * tied.p_keyframe_antenna);
    pairs.enu.push_back(tied.fix.p_enu);
    const std::size_t n = pairs.map.size();
    travelled_m.push_back(n < 2 ? 0 : travelled_m.back() + (pairs.map[n - 1] - pairs.map[n - 2]).norm());
  }
  for (std::size_t n = 0; n < fixes.size(); ++n) {
    const double drift_m = options.driftPerMetre * std::abs(travelled_m[n] - 0.5 * travelled_m.back());
    const Eigen::Vector3d sigma_m = fixes[n].fix.sigma_m.cwiseMax(options.minSigma_m);
    pairs.sigma_m.emplace_back((sigma_m.array().square() + drift_m * drift_m).sqrt());
  }
  return pairs;
}

/// Weighted least-squares T_enu_map of yaw and translation (Umeyama in the plane, mean height apart).
core::Isometry align(const Pairs& pairs, const std::vector<double>& weights) {
  Eigen::Vector3d meanMap = Eigen::Vector3d::Zero(), meanEnu = Eigen::Vector3d::Zero();
  double sum = 0;
  for (std::size_t n = 0; n < weights.size(); ++n) {
    const double w = weights[n] / pairs.sigma_m[n].head<2>().squaredNorm();
    meanMap += w * pairs.map[n];
    meanEnu += w * pairs.enu[n];
    sum += w;
  }
  meanMap /= sum;
  meanEnu /= sum;
  double cosine = 0, sine = 0;
  for (std::size_t n = 0; n < weights.size(); ++n) {
    const double w = weights[n] / pairs.sigma_m[n].head<2>().squaredNorm();
    const Eigen::Vector3d a = pairs.map[n] - meanMap, b = pairs.enu[n] - meanEnu;
    cosine += w * (a.x() * b.x() + a.y() * b.y());
    sine += w * (a.x() * b.y() - a.y() * b.x());
  }
  core::Isometry T = core::isometryFromXyzYpr(0, 0, 0, std::atan2(sine, cosine), 0, 0);
  T.translation() = meanEnu - T.linear() * meanMap;
  return T;
}

std::vector<double> squaredResiduals(const Pairs& pairs, const core::Isometry& T_enu_map) {
  std::vector<double> squares;
  for (std::size_t n = 0; n < pairs.map.size(); ++n)
    squares.push_back((T_enu_map * pairs.map[n] - pairs.enu[n]).cwiseQuotient(pairs.sigma_m[n]).squaredNorm());
  return squares;
}

/// Graduated non-convexity with a truncated least-squares loss (Yang et al., RA-L 2020): from convex to truncated at
/// the gate, so that no starting guess and no majority of one sign is needed.
core::Isometry robustAlign(const Pairs& pairs, double gate) {
  const double gate2 = gate * gate;
  std::vector<double> weights(pairs.map.size(), 1.0);
  core::Isometry T = align(pairs, weights);
  std::vector<double> squares = squaredResiduals(pairs, T);
  const double largest = *std::max_element(squares.begin(), squares.end());
  if (largest <= gate2) return T;
  double mu = gate2 / (2 * largest - gate2);
  while (mu < 1e6) {
    for (std::size_t n = 0; n < weights.size(); ++n) {
      if (squares[n] <= mu / (mu + 1) * gate2)
        weights[n] = 1;
      else if (squares[n] >= (mu + 1) / mu * gate2)
        weights[n] = 1e-12;
      else
        weights[n] = std::sqrt(gate2 * mu * (mu + 1) / squares[n]) - mu;
    }
    T = align(pairs, weights);
    squares = squaredResiduals(pairs, T);
    mu *= 1.4;
  }
  return T;
}

void countUnbelievable(const std::vector<TiedFix>& fixes, const std::vector<bool>& believable, GnssReport& report) {
  int run = 0;
  for (std::size_t n = 0; n < fixes.size(); ++n) {
    run = believable[n] ? 0 : run + 1;
    if (!believable[n]) ++report.unbelievable;
    if (run <= report.longestRun) continue;
    report.longestRun = run;
    report.distrustedSince = fixes[n - static_cast<std::size_t>(run) + 1].fix.time;
  }
}

/// Joins unbelievable fixes that at most two believable ones part; fewer than three together are multipath, no span.
std::vector<GnssSpan> spansOf(const std::vector<TiedFix>& fixes, const std::vector<bool>& believable,
                              const std::vector<double>& deviations_m) {
  constexpr int kBridged = 2, kFewest = 3;
  std::vector<GnssSpan> spans;
  std::size_t last = 0;
  for (std::size_t n = 0; n < fixes.size(); ++n) {
    if (believable[n]) continue;
    if (spans.empty() || n - last > kBridged + 1) spans.push_back({fixes[n].fix.time, 0, 0, 0});
    GnssSpan& span = spans.back();
    span.to = fixes[n].fix.time;
    ++span.fixes;
    span.largestDeviation_m = std::max(span.largestDeviation_m, deviations_m[n]);
    last = n;
  }
  spans.erase(std::remove_if(spans.begin(), spans.end(), [](const GnssSpan& s) { return s.fixes < kFewest; }),
              spans.end());
  return spans;
}

}  // namespace

const char* gnssStateName(GnssState state) {
  switch (state) {
    case GnssState::absent:
      return "absent";
    case GnssState::tooShort:
      return "too short to align";
    case GnssState::trusted:
      return "trusted";
    case GnssState::distrusted:
      return "distrusted";
  }
  return "?";
}

GnssAssessment assessGnss(const std::vector<TiedFix>& fixes, const std::vector<Keyframe>& keyframes,
                          const GnssOptions& options) {
  GnssAssessment assessment;
  GnssReport& report = assessment.report;
  report.fixes = static_cast<int>(fixes.size());
  assessment.believable.assign(fixes.size(), false);
  if (!options.enabled || fixes.empty()) return assessment;
  report.state = GnssState::tooShort;
  const Pairs pairs = makePairs(fixes, keyframes, options);
  double extent_m = 0;
  for (const auto& p : pairs.map) extent_m = std::max(extent_m, (p - pairs.map.front()).norm());
  if (report.fixes < options.minFixes || extent_m < options.minTrack_m) return assessment;

  const core::Isometry T_enu_map = robustAlign(pairs, options.gate);
  const std::vector<double> squares = squaredResiduals(pairs, T_enu_map);
  std::vector<double> deviations_m;
  for (std::size_t n = 0; n < fixes.size(); ++n) {
    assessment.believable[n] = squares[n] <= options.gate * options.gate;
    deviations_m.push_back((T_enu_map * pairs.map[n] - pairs.enu[n]).head<2>().norm());
    report.largestDeviation_m = std::max(report.largestDeviation_m, deviations_m.back());
  }
  countUnbelievable(fixes, assessment.believable, report);
  report.spans = spansOf(fixes, assessment.believable, deviations_m);
  const bool lies = report.longestRun >= options.distrustRun ||
                    report.unbelievable > options.distrustShare * static_cast<double>(report.fixes);
  report.state = lies ? GnssState::distrusted : GnssState::trusted;
  if (report.unbelievable * 2 < report.fixes) report.T_enu_map = T_enu_map;
  return assessment;
}

}  // namespace s2s::graph
