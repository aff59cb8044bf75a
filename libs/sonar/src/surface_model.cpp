#include "s2s/sonar/surface_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "s2s/sonar/ping_geometry.h"

namespace s2s::sonar {

namespace {

constexpr int kUnknowns = 5;  // the plane, and the offsets of the near and of the far edge
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
// Speckle and weak echoes make a strip's first feature late and its last one early, hardly ever the other way: the edge
// is near the outer end of what the strips show, so a quantile is fitted and not the mean.
constexpr double kEdgeQuantile = 0.25;
constexpr double kLeastEdgeScale = 0.005;  // of the range; half a bin does not count as scatter
constexpr int kIterations = 10;
constexpr double kOffsetSigma = 0.1;             // prior of the offsets, as a share of the range
constexpr double kEdgeWidth_rad = M_PI / 180.0;  // edges are looked for in strips of this width
constexpr std::size_t kLeastStrips = 8, kLeastRows = 6;

/// One linear equation a . x = b with its standard deviation, all as a share of the range.
struct Equation {
  Unknowns a = Unknowns::Zero();
  double b = 0, sigma = 1;
  int inward = 0;  ///< of an edge: the sign of the residual of a feature within the edge; 0 for rows and priors
  double residual(const Unknowns& x) const { return a.dot(x) - b; }
};

Eigen::Vector3d pointOf(const ElevationSample& s, double elevation_rad) {
  return pointAt({s.range_m, s.bearing_rad, elevation_rad}, obs::BearingModel::Azimuth);
}

/// Members of rows of equal range that the vertical sonar knows something of.
std::map<long, std::vector<const ElevationSample*>> rowsOf(const std::vector<ElevationSample>& samples,
                                                           double rowLength_m) {
  std::map<long, std::vector<const ElevationSample*>> rows;
  for (const auto& s : samples)
    if (s.known) rows[std::lround(s.range_m / rowLength_m)].push_back(&s);
  return rows;
}

/// The equations of one cluster and their robust solution.
class PlaneProblem {
 public:
  PlaneProblem(const std::vector<ElevationSample>& samples, double aperture_rad, const SurfaceModelOptions& options)
      : options_(options) {
    addRows(samples);
    addEdges(samples, aperture_rad);
    for (const int offset : {3, 4}) {
      Equation prior;
      prior.a[offset] = 1;
      prior.sigma = kOffsetSigma;
      equations_.push_back(prior);
    }
  }

  bool isSolvable() const { return rows_ >= kLeastRows && strips_ >= kLeastStrips; }

  /// Iterated least squares with the weights of an asymmetric Laplace distribution: the quantile of either edge. Both
  /// edges have a scale of their own, since the far one is often where the echo becomes too weak.
  Unknowns solve() {
    Unknowns x = solveOnce();
    for (int i = 0; i < kIterations; ++i) {
      for (const int inward : {1, -1}) weighEdges(x, inward);
      x = solveOnce();
    }
    return x;
  }

  /// Robust standard deviation of the edges (1.48 times their median size).
  double edgeScatter(const Unknowns& x) const {
    std::vector<double> sizes;
    for (const Equation& e : equations_)
      if (e.inward != 0) sizes.push_back(std::abs(e.residual(x)));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return 1.48 * *middle;
  }

 private:
  void addRows(const std::vector<ElevationSample>& samples) {
    for (const auto& [row, members] : rowsOf(samples, options_.rowLength_m)) {
      Equation e;
      e.sigma = options_.rowSigma;
      e.b = 1;
      for (const auto* s : members)
        e.a.head<3>() += pointOf(*s, s->meanElevation_rad) / static_cast<double>(members.size());
      equations_.push_back(e);
      growth_ += members.front()->meanElevation_rad * static_cast<double>(row);
      meanElevation_ += members.front()->meanElevation_rad;
      meanRow_ += static_cast<double>(row);
      ++rows_;
    }
  }

  /// Does the elevation grow with range?
  bool isRising() const {
    const double n = std::max<double>(1, static_cast<double>(rows_));
    return growth_ / n >= meanElevation_ / n * (meanRow_ / n);
  }

  void addEdges(const std::vector<ElevationSample>& samples, double aperture_rad) {
    struct Limits {
      ElevationSample nearest, farthest;
    };
    std::map<long, Limits> strips;
    for (const auto& s : samples) {
      const auto [it, fresh] = strips.try_emplace(std::lround(s.bearing_rad / kEdgeWidth_rad), Limits{s, s});
      if (s.range_m < it->second.nearest.range_m) it->second.nearest = s;
      if (s.range_m > it->second.farthest.range_m) it->second.farthest = s;
    }
    const double nearElevation_rad = isRising() ? -0.5 * aperture_rad : 0.5 * aperture_rad;
    for (const auto& [strip, limits] : strips) {
      addEdge(pointOf(limits.nearest, nearElevation_rad), 3, 1);
      addEdge(pointOf(limits.farthest, -nearElevation_rad), 4, -1);
    }
    strips_ = strips.size();
  }

  void addEdge(const Eigen::Vector3d& p, int offset, int inward) {
    Equation e;
    e.a.head<3>() = p;
    e.a[offset] = 1;
    e.b = 1;
    e.sigma = options_.edgeSigma;
    e.inward = inward;
    equations_.push_back(e);
  }

  /// Twice the share of the edge's features that should lie on the residual's side.
  static double asymmetry(double depth) { return 2 * (depth > 0 ? kEdgeQuantile : 1 - kEdgeQuantile); }

  void weighEdges(const Unknowns& x, int inward) {
    double sum = 0, count = 0;
    for (const Equation& e : equations_) {
      if (e.inward != inward) continue;
      const double depth = inward * e.residual(x);
      sum += asymmetry(depth) * std::abs(depth);
      ++count;
    }
    const double scale = std::max(kLeastEdgeScale, sum / count);
    for (Equation& e : equations_) {
      if (e.inward != inward) continue;
      const double depth = inward * e.residual(x);
      e.sigma = std::sqrt(scale * std::max(std::abs(depth), 0.2 * scale) / asymmetry(depth));
    }
  }

  Unknowns solveOnce() const {
    Eigen::Matrix<double, kUnknowns, kUnknowns> N = Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
    Unknowns g = Unknowns::Zero();
    for (const Equation& e : equations_) {
      const double w = 1 / (e.sigma * e.sigma);
      N += w * e.a * e.a.transpose();
      g += w * e.a * e.b;
    }
    return N.ldlt().solve(g);
  }

  const SurfaceModelOptions& options_;
  std::vector<Equation> equations_;
  std::size_t rows_ = 0, strips_ = 0;
  double growth_ = 0, meanElevation_ = 0, meanRow_ = 0;
};

}  // namespace

std::optional<SurfaceModel> SurfaceModel::fit(const std::vector<ElevationSample>& samples, double aperture_rad,
                                              const SurfaceModelOptions& options) {
  PlaneProblem problem(samples, aperture_rad, options);
  if (!problem.isSolvable()) return std::nullopt;
  const Unknowns x = problem.solve();
  SurfaceModel model;
  model.q_ = x.head<3>();
  model.edgeScatter_ = problem.edgeScatter(x);
  model.rowLength_m_ = options.rowLength_m;
  if (!x.allFinite() || model.edgeScatter_ > options.maxEdgeScatter) return std::nullopt;
  if (!model.isSteepEnough(options.minSlope)) return std::nullopt;
  model.fillRows(samples);
  return model;
}

/// On q . p = 1 the range is 1 / (q . u), so d range / d elevation / range = -(q . du) / (q . u); here on the axis.
bool SurfaceModel::isSteepEnough(double minSlope) const { return std::abs(q_.z()) >= minSlope * std::abs(q_.x()); }

std::optional<double> SurfaceModel::planeElevation(double range_m, double bearing_rad, double near_rad) const {
  // a cos(e) + q_z sin(e) = 1 / range; of the two solutions the one nearer to `near_rad`.
  const double a = q_.x() * std::cos(bearing_rad) + q_.y() * std::sin(bearing_rad);
  const double length = std::hypot(a, q_.z()), cosine = 1 / (range_m * length);
  if (!(cosine <= 1)) return std::nullopt;
  const double middle = std::atan2(q_.z(), a), half = std::acos(cosine);
  const double one = middle + half, other = middle - half;
  return std::abs(one - near_rad) < std::abs(other - near_rad) ? one : other;
}

void SurfaceModel::fillRows(const std::vector<ElevationSample>& samples) {
  for (const auto& [index, members] : rowsOf(samples, rowLength_m_)) {
    Row row;
    double count = 0;
    for (const auto* s : members) {
      const auto plane = planeElevation(s->range_m, s->bearing_rad, s->meanElevation_rad);
      if (!plane) continue;
      row.meanElevation_rad += s->meanElevation_rad;
      row.meanPlaneElevation_rad += *plane;
      ++count;
    }
    if (count == 0) continue;
    row.meanElevation_rad /= count;
    row.meanPlaneElevation_rad /= count;
    rows_[index] = row;
  }
}

std::optional<double> SurfaceModel::elevation(double range_m, double bearing_rad) const {
  const auto row = rows_.find(std::lround(range_m / rowLength_m_));
  if (row == rows_.end()) return std::nullopt;
  const auto plane = planeElevation(range_m, bearing_rad, row->second.meanElevation_rad);
  if (!plane) return std::nullopt;
  return row->second.meanElevation_rad + *plane - row->second.meanPlaneElevation_rad;
}

}  // namespace s2s::sonar
