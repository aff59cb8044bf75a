#include "match_candidates.h"

#include <algorithm>
#include <cmath>

#include "s2s/sonar/arc_intersection.h"

namespace s2s::sonar {

namespace {

/// Mean and standard deviation of a cluster's intensity context: makes sonars of different gain comparable.
struct IntensityScale {
  double mean = 0, sigma = 1;
};

double contextOf(const Feature& f) { return 0.5 * (f.contextX + f.contextY); }

std::vector<IntensityScale> intensityScales(const std::vector<Feature>& features) {
  std::vector<IntensityScale> scales;
  std::vector<double> count, sum, squares;
  for (const Feature& f : features) {
    if (f.cluster < 0) continue;
    const auto c = static_cast<std::size_t>(f.cluster);
    if (c >= scales.size()) {
      scales.resize(c + 1);
      count.resize(c + 1), sum.resize(c + 1), squares.resize(c + 1);
    }
    count[c] += 1;
    sum[c] += contextOf(f);
    squares[c] += contextOf(f) * contextOf(f);
  }
  for (std::size_t c = 0; c < scales.size(); ++c) {
    if (count[c] == 0) continue;
    scales[c].mean = sum[c] / count[c];
    scales[c].sigma = std::max(1.0, std::sqrt(std::max(0.0, squares[c] / count[c] - scales[c].mean * scales[c].mean)));
  }
  return scales;
}

std::vector<double> standardised(const std::vector<Feature>& features) {
  const auto scales = intensityScales(features);
  std::vector<double> values(features.size(), 0);
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (features[i].cluster < 0) continue;
    const auto& scale = scales[static_cast<std::size_t>(features[i].cluster)];
    values[i] = (contextOf(features[i]) - scale.mean) / scale.sigma;
  }
  return values;
}

/// Indices of the features of each cluster, in order of range.
std::vector<std::vector<int>> byCluster(const std::vector<Feature>& features) {
  std::vector<std::vector<int>> members;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (features[i].cluster < 0) continue;
    const auto c = static_cast<std::size_t>(features[i].cluster);
    if (c >= members.size()) members.resize(c + 1);
    members[c].push_back(static_cast<int>(i));
  }
  for (auto& m : members)
    std::stable_sort(m.begin(), m.end(), [&](int a, int b) {
      return features[static_cast<std::size_t>(a)].range_m < features[static_cast<std::size_t>(b)].range_m;
    });
  return members;
}

/// Candidates by geometry.
class GeometricSearch {
 public:
  GeometricSearch(const std::vector<Feature>& horizontal, const std::vector<Feature>& vertical,
                  const PairGeometry& geometry, const FeatureAssociationOptions& options)
      : horizontal_(horizontal),
        geometry_(geometry),
        options_(options),
        intersector_(geometry.T_h_v, geometry.aperture_h_rad, geometry.aperture_v_rad, options.apertureMargin_rad),
        intensity_h_(standardised(horizontal)),
        intensity_v_(standardised(vertical)) {
    const core::Isometry T_v_h = geometry.T_h_v.inverse();
    for (const Feature& v : vertical) planes_.push_back(planeOf(v.range_m, v.beamBearing_rad, geometry.model_v, T_v_h));
  }

  void search(const std::vector<int>& membersH, const std::vector<int>& membersV, std::vector<Candidate>& out) const {
    for (const int h : membersH) searchOne(h, membersV, out);
  }

 private:
  /// Standard deviation of the range misfit: both ranges, and both bearings over the lever arm between the sonars.
  double misfitSigma(const Feature& h) const {
    const double lever_m = geometry_.T_h_v.translation().norm() * h.bearingSigma_rad;
    return std::sqrt(geometry_.rangeSigma_h_m * geometry_.rangeSigma_h_m +
                     geometry_.rangeSigma_v_m * geometry_.rangeSigma_v_m + 2 * lever_m * lever_m);
  }

  void searchOne(int h, const std::vector<int>& membersV, std::vector<Candidate>& out) const {
    const Feature& feature = horizontal_[static_cast<std::size_t>(h)];
    const FeatureArc arc = arcOf(feature.range_m, feature.bearing_rad, geometry_.model_h);
    const double sigma = misfitSigma(feature), gate = options_.maxResidual * sigma;
    const auto [nearest, farthest] = intersector_.rangesFromVertical(arc);
    auto it = std::lower_bound(membersV.begin(), membersV.end(), nearest - gate, [this](int v, double range) {
      return planes_[static_cast<std::size_t>(v)].range_m < range;
    });
    for (; it != membersV.end(); ++it) {
      const BeamPlane& plane = planes_[static_cast<std::size_t>(*it)];
      if (plane.range_m > farthest + gate) break;
      const auto point = intersector_.intersect(arc, plane);
      if (!point || std::abs(point->rangeMisfit_m) > gate) continue;
      const double misfit = point->rangeMisfit_m / sigma;
      const double contrast = intensity_h_[static_cast<std::size_t>(h)] - intensity_v_[static_cast<std::size_t>(*it)];
      const double cost = misfit * misfit + options_.intensityWeight * contrast * contrast;
      out.push_back(
          {h, *it, static_cast<float>(cost), static_cast<float>(std::asin(point->p_h.z() / feature.range_m))});
    }
  }

  const std::vector<Feature>& horizontal_;
  const PairGeometry& geometry_;
  const FeatureAssociationOptions& options_;
  ArcIntersector intersector_;
  std::vector<double> intensity_h_, intensity_v_;
  std::vector<BeamPlane> planes_;
};

/// The paper's cost; the horizontal feature's `literalNeighbours` best partners.
void searchLiterally(const std::vector<Feature>& horizontal, const std::vector<Feature>& vertical,
                     const std::vector<int>& membersH, const std::vector<int>& membersV, int neighbours,
                     std::vector<Candidate>& out) {
  std::vector<std::pair<double, int>> costs(membersV.size());
  const std::size_t kept = std::min(membersV.size(), static_cast<std::size_t>(neighbours));
  for (const int i : membersH) {
    const Feature& h = horizontal[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < membersV.size(); ++k) {
      const Feature& v = vertical[static_cast<std::size_t>(membersV[k])];
      const double dx = h.p_h.x() - v.p_h.x();
      const double dg = h.intensity - v.intensity, d1 = h.contextX - v.contextY, d2 = h.contextY - v.contextX;
      costs[k] = {std::sqrt(dx * dx + dg * dg + d1 * d1 + d2 * d2), membersV[k]};
    }
    std::partial_sort(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(kept), costs.end());
    for (std::size_t k = 0; k < kept; ++k) {
      const auto& v = vertical[static_cast<std::size_t>(costs[k].second)];
      out.push_back({i, costs[k].second, static_cast<float>(costs[k].first),
                     static_cast<float>(std::asin(v.p_h.z() / v.p_h.norm()))});
    }
  }
}

}  // namespace

std::vector<Candidate> findCandidates(const std::vector<Feature>& horizontal, const std::vector<Feature>& vertical,
                                      const std::vector<ClusterPair>& pairs, const PairGeometry& geometry,
                                      const FeatureAssociationOptions& options) {
  const auto membersH = byCluster(horizontal), membersV = byCluster(vertical);
  const GeometricSearch geometric(horizontal, vertical, geometry, options);
  std::vector<Candidate> candidates;
  for (const ClusterPair& pair : pairs) {
    const auto& h = membersH[static_cast<std::size_t>(pair.horizontal)];
    const auto& v = membersV[static_cast<std::size_t>(pair.vertical)];
    if (options.cost == FeatureCost::Geometric)
      geometric.search(h, v, candidates);
    else
      searchLiterally(horizontal, vertical, h, v, options.literalNeighbours, candidates);
  }
  const auto byFeature = [](const Candidate& a, const Candidate& b) { return a.horizontal < b.horizontal; };
  std::stable_sort(candidates.begin(), candidates.end(), byFeature);
  return candidates;
}

}  // namespace s2s::sonar
