#include "s2s/sonar/feature_association.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "match_candidates.h"

namespace s2s::sonar {

namespace {

/// Candidates of one horizontal feature that are almost as good as its best: how far apart their points are.
struct Spread {
  double width_rad = 0, sigma_rad = 0;
};

Spread spreadOf(const Candidate* begin, const Candidate* end, double margin) {
  float best = std::numeric_limits<float>::infinity();
  for (const Candidate* c = begin; c != end; ++c) best = std::min(best, c->cost);
  double low = std::numeric_limits<double>::infinity(), high = -low, weight = 0, sum = 0, squares = 0;
  for (const Candidate* c = begin; c != end; ++c) {
    if (c->cost > best + margin) continue;
    const double w = std::exp(-0.5 * (c->cost - best));
    low = std::min(low, static_cast<double>(c->elevation_rad));
    high = std::max(high, static_cast<double>(c->elevation_rad));
    weight += w;
    sum += w * c->elevation_rad;
    squares += w * c->elevation_rad * c->elevation_rad;
  }
  const double mean = sum / weight;
  return {high - low, std::sqrt(std::max(0.0, squares / weight - mean * mean))};
}

/// Drops ambiguous horizontal features and notes the spread of the others.
std::vector<Candidate> resolveAmbiguity(const std::vector<Candidate>& candidates,
                                        const std::vector<Feature>& horizontal,
                                        const FeatureAssociationOptions& options, std::vector<double>& spread_m,
                                        std::size_t& rejected) {
  std::vector<Candidate> kept;
  kept.reserve(candidates.size());
  for (std::size_t begin = 0; begin < candidates.size();) {
    std::size_t end = begin;
    while (end < candidates.size() && candidates[end].horizontal == candidates[begin].horizontal) ++end;
    const Spread spread = spreadOf(&candidates[begin], &candidates[begin] + (end - begin), options.ambiguityCost);
    const auto h = static_cast<std::size_t>(candidates[begin].horizontal);
    spread_m[h] = spread.sigma_rad * horizontal[h].range_m;
    if (options.ambiguity == AmbiguityRule::Reject && spread.width_rad * horizontal[h].range_m > options.maxSpread_m)
      ++rejected;
    else
      kept.insert(kept.end(), candidates.begin() + static_cast<std::ptrdiff_t>(begin),
                  candidates.begin() + static_cast<std::ptrdiff_t>(end));
    begin = end;
  }
  return kept;
}

/// Every horizontal feature with the elevations that the vertical sonar offers for it.
std::vector<ElevationSample> elevationSamples(const std::vector<Candidate>& candidates,
                                              const std::vector<Feature>& horizontal,
                                              const std::vector<Feature>& vertical) {
  std::vector<ElevationSample> samples;
  samples.reserve(horizontal.size());
  std::vector<double> weights(horizontal.size(), 0);
  for (const Feature& h : horizontal) samples.push_back({h.range_m, h.bearing_rad, false, 0});
  for (const Candidate& c : candidates) {
    const auto h = static_cast<std::size_t>(c.horizontal);
    const double w = static_cast<double>(vertical[static_cast<std::size_t>(c.vertical)].intensity) *
                     std::exp(-0.5 * static_cast<double>(c.cost));
    weights[h] += w;
    samples[h].meanElevation_rad += w * c.elevation_rad;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].known = weights[i] > 0;
    if (samples[i].known) samples[i].meanElevation_rad /= weights[i];
  }
  return samples;
}

/// Cost of leaving a feature alone: above every candidate, so no feature stays alone that has a free partner.
double unmatchedCostFor(const std::vector<Candidate>& candidates) {
  float highest = 0;
  for (const Candidate& c : candidates) highest = std::max(highest, c.cost);
  return static_cast<double>(highest) + 1.0;
}

using Elevations = std::vector<std::optional<double>>;

/// Fits a surface to each horizontal cluster and gives the elevation it has at each feature, where it has one.
Elevations surfaceElevations(const std::vector<Candidate>& candidates, const std::vector<Feature>& horizontal,
                             const std::vector<Feature>& vertical, double aperture_rad,
                             const SurfaceModelOptions& options, std::size_t& surfaces) {
  const auto samples = elevationSamples(candidates, horizontal, vertical);
  std::vector<std::vector<ElevationSample>> members;
  for (std::size_t i = 0; i < horizontal.size(); ++i) {
    if (horizontal[i].cluster < 0) continue;
    const auto c = static_cast<std::size_t>(horizontal[i].cluster);
    if (c >= members.size()) members.resize(c + 1);
    members[c].push_back(samples[i]);
  }
  std::vector<std::optional<SurfaceModel>> models;
  for (const auto& cluster : members) {
    models.push_back(SurfaceModel::fit(cluster, aperture_rad, options));
    surfaces += models.back() ? 1 : 0;
  }
  Elevations elevations(horizontal.size());
  for (std::size_t i = 0; i < horizontal.size(); ++i) {
    const Feature& h = horizontal[i];
    if (!samples[i].known || h.cluster < 0) continue;
    const auto& model = models[static_cast<std::size_t>(h.cluster)];
    if (model) elevations[i] = model->elevation(h.range_m, h.bearing_rad);
  }
  return elevations;
}

/// Adds the squared distance from the surface to the candidates' costs.
void addSurfaceCosts(std::vector<Candidate>& candidates, const Elevations& expected, double sigma_rad) {
  for (Candidate& c : candidates) {
    const auto& elevation_rad = expected[static_cast<std::size_t>(c.horizontal)];
    if (!elevation_rad) continue;
    const double off = (c.elevation_rad - *elevation_rad) / sigma_rad;
    c.cost += static_cast<float>(off * off);
  }
}

void dropExpensive(std::vector<Candidate>& candidates, double maxCost) {
  candidates.erase(
      std::remove_if(candidates.begin(), candidates.end(), [maxCost](const Candidate& c) { return c.cost > maxCost; }),
      candidates.end());
}

Assignment assignCandidates(const std::vector<Candidate>& candidates, std::size_t rows, std::size_t columns,
                            const AssignmentOptions& options) {
  AssignmentProblem problem;
  problem.rows = static_cast<int>(rows);
  problem.columns = static_cast<int>(columns);
  problem.unmatchedCost = unmatchedCostFor(candidates);
  problem.edges.reserve(candidates.size());
  for (const Candidate& c : candidates) problem.edges.push_back({c.horizontal, c.vertical, c.cost});
  return assign(problem, options);
}

}  // namespace

FeatureAssociation associateFeatures(const std::vector<Feature>& horizontal, const std::vector<Feature>& vertical,
                                     const std::vector<ClusterPair>& clusterPairs, const PairGeometry& geometry,
                                     const FeatureAssociationOptions& options) {
  FeatureAssociation result;
  auto candidates = findCandidates(horizontal, vertical, clusterPairs, geometry, options);
  result.candidates = candidates.size();
  Elevations expected(horizontal.size());
  std::vector<double> spread_m(horizontal.size(), 0);
  if (options.cost == FeatureCost::Geometric) {
    if (options.surface.enabled)
      expected = surfaceElevations(candidates, horizontal, vertical, geometry.aperture_h_rad, options.surface,
                                   result.surfaces);
    addSurfaceCosts(candidates, expected, options.surfaceSigma_rad);
    dropExpensive(candidates, options.maxCost);
    if (options.ambiguity != AmbiguityRule::Ignore)
      candidates = resolveAmbiguity(candidates, horizontal, options, spread_m, result.ambiguous);
  }
  const Assignment assignment = assignCandidates(candidates, horizontal.size(), vertical.size(), options.assignment);
  result.cost = assignment.cost;
  result.lowerBound = assignment.lowerBound;
  for (const Candidate& c : candidates) {
    const auto h = static_cast<std::size_t>(c.horizontal);
    if (assignment.columnOfRow[h] != c.vertical) continue;
    if (!result.matches.empty() && result.matches.back().horizontal == h) continue;
    const Feature& v = vertical[static_cast<std::size_t>(c.vertical)];
    // Without a surface to choose among the beams of a run, its centre is the best guess.
    const bool chosen = expected[h].has_value();
    result.matches.push_back({h, static_cast<std::size_t>(c.vertical), c.cost,
                              chosen ? v.beamBearing_rad : v.bearing_rad,
                              chosen ? options.surfaceSigma_rad : v.bearingSigma_rad, spread_m[h]});
  }
  return result;
}

}  // namespace s2s::sonar
