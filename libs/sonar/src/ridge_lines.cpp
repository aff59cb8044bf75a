#include "ridge_lines.h"

#include <algorithm>
#include <cmath>

namespace s2s::sonar {

namespace {

/// A run of beams so many times as wide as its ridges are long is of a surface that faces the sonar within some
/// degrees.
constexpr double kFacing = 4;
/// Fewer beams are a glint.
constexpr std::size_t kFewestBeams = 3;
/// Beams that may be missing within a run: speckle darkens single ones.
constexpr std::size_t kMissingBeams = 1;
/// Places a line needs; and it must not be seen under a more grazing angle than this sine.
constexpr std::size_t kMinPlaces = 8;
constexpr double kLeastIncidence = 0.1;
/// Places further from the ridge than this share of its range are of another surface.
constexpr double kSameSurface = 0.1;
/// Tukey's constant for 95 % efficiency, and the factor that makes a median of magnitudes a standard deviation.
constexpr double kTukey = 4.685, kMadToSigma = 1.4826;
constexpr double kLeastScatter_m = 0.002;
constexpr int kSteps = 10;

/// A run of beams at one range that is still growing.
struct Run {
  std::size_t first = 0, last = 0, beams = 0;  ///< indices of the ping's beams
  double bins = 0;                             ///< lengths of their ridges together
  double weight = 0, weightedBearing = 0;
};

/// A line n . p = d by weighted least squares of the distances from it.
struct Line {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero(), normal = Eigen::Vector2d::UnitX();
  double alongVariance_m2 = 0;
  double distance_m(const Eigen::Vector2d& p) const { return normal.dot(p - centre); }
};

Line fitLine(const std::vector<Eigen::Vector2d>& places, const std::vector<double>& weights) {
  Line line;
  double sum = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    sum += weights[i];
    line.centre += weights[i] * places[i];
  }
  line.centre /= sum;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Vector2d d = places[i] - line.centre;
    xx += weights[i] * d.x() * d.x();
    xy += weights[i] * d.x() * d.y();
    yy += weights[i] * d.y() * d.y();
  }
  // Direction of the larger principal axis; the normal is across it.
  const double along_rad = 0.5 * std::atan2(2 * xy, xx - yy);
  line.normal = {-std::sin(along_rad), std::cos(along_rad)};
  line.alongVariance_m2 = (0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy)) / sum;
  return line;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A line, the scatter about it and how many independent places it rests on.
struct RobustLine {
  Line line;
  double scatter_m = 0;
  double independent = 0;
};

/// Places that share speckle are off alike: neighbours' residuals tell how much (an autoregressive process of order 1).
double independentCount(const std::vector<double>& residuals, const std::vector<double>& weights) {
  double product = 0, square = 0, count = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (weights[i] <= 0) continue;
    count += 1;
    square += residuals[i] * residuals[i];
    if (i > 0 && weights[i - 1] > 0) product += residuals[i] * residuals[i - 1];
  }
  const double correlation = square > 0 ? std::clamp(product / square, 0.0, 0.95) : 0.0;
  return count * (1 - correlation) / (1 + correlation);
}

RobustLine fitRobustly(const std::vector<Eigen::Vector2d>& places) {
  std::vector<double> weights(places.size(), 1.0), residuals(places.size()), magnitudes(places.size());
  RobustLine result;
  for (int step = 0; step < kSteps; ++step) {
    result.line = fitLine(places, weights);
    for (std::size_t i = 0; i < places.size(); ++i) {
      residuals[i] = result.line.distance_m(places[i]);
      magnitudes[i] = std::abs(residuals[i]);
    }
    result.scatter_m = std::max(kLeastScatter_m, kMadToSigma * median(magnitudes));
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double u = residuals[i] / (kTukey * result.scatter_m);
      weights[i] = std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
    }
  }
  result.independent = independentCount(residuals, weights);
  return result;
}

}  // namespace

RidgeLines::RidgeLines(const std::vector<Ridge>& ridges, const cv::Mat& beams, const PingGeometry& geometry)
    : geometry_(geometry) {
  std::vector<Run> runs(static_cast<std::size_t>(beams.cols));
  const auto close = [&](int bin) {
    Run& run = runs[static_cast<std::size_t>(bin)];
    const double width_m =
        geometry.range_m(bin) * std::abs(geometry.bearings_rad[run.last] - geometry.bearings_rad[run.first]);
    const double length_m = run.bins / static_cast<double>(run.beams) * geometry.rangeResolution_m;
    const bool isCutOff = run.first == 0 || run.last + 1 == geometry.beamCount();
    if (run.beams >= kFewestBeams && width_m > kFacing * length_m)
      addMiddles(ridges, bin, run.first, run.last);
    else if (run.beams >= kFewestBeams && !isCutOff)
      add(run.weightedBearing / run.weight, geometry.range_m(bin));
    run = Run();
  };
  for (const Ridge& ridge : ridges) {
    const auto* samples = beams.ptr<std::uint8_t>(static_cast<int>(ridge.beam));
    for (int bin = ridge.begin; bin < ridge.end; ++bin) {
      if (runs[static_cast<std::size_t>(bin)].beams > 0 &&
          ridge.beam - runs[static_cast<std::size_t>(bin)].last > kMissingBeams + 1)
        close(bin);
      Run& run = runs[static_cast<std::size_t>(bin)];
      if (run.beams == 0) run.first = ridge.beam;
      run.last = ridge.beam;
      ++run.beams;
      run.bins += ridge.end - ridge.begin;
      run.weight += samples[bin];
      run.weightedBearing += samples[bin] * geometry.bearings_rad[ridge.beam];
    }
  }
  for (int bin = 0; bin < beams.cols; ++bin)
    if (runs[static_cast<std::size_t>(bin)].beams > 0) close(bin);
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.bearing_rad < b.bearing_rad; });
}

void RidgeLines::add(double bearing_rad, double range_m) {
  places_.push_back({bearing_rad, range_m * Eigen::Vector2d(std::cos(bearing_rad), std::sin(bearing_rad))});
}

void RidgeLines::addMiddles(const std::vector<Ridge>& ridges, int bin, std::size_t first, std::size_t last) {
  for (const Ridge& ridge : ridges)
    if (ridge.beam >= first && ridge.beam <= last && std::lround(ridge.centre) == bin)
      add(geometry_.bearings_rad[ridge.beam], geometry_.range_m(ridge.centre));
}

std::optional<RidgeLines::Range> RidgeLines::at(const Ridge& ridge, double window_rad) const {
  const double bearing_rad = geometry_.bearings_rad[ridge.beam], own_m = geometry_.range_m(ridge.centre);
  std::vector<Eigen::Vector2d> near;
  bool isBefore = false, isBehind = false;  // a line is not extended beyond its places
  auto place = std::lower_bound(places_.begin(), places_.end(), bearing_rad - window_rad,
                                [](const Place& p, double bearing) { return p.bearing_rad < bearing; });
  for (; place != places_.end() && place->bearing_rad <= bearing_rad + window_rad; ++place)
    if (std::abs(place->p.norm() - own_m) < kSameSurface * own_m) {
      near.push_back(place->p);
      isBefore = isBefore || place->bearing_rad <= bearing_rad;
      isBehind = isBehind || place->bearing_rad >= bearing_rad;
    }
  if (near.size() < kMinPlaces || !isBefore || !isBehind) return std::nullopt;

  const RobustLine fit = fitRobustly(near);
  const Eigen::Vector2d beam(std::cos(bearing_rad), std::sin(bearing_rad));
  const double incidence = fit.line.normal.dot(beam);
  if (std::abs(incidence) < kLeastIncidence || fit.line.alongVariance_m2 <= 0) return std::nullopt;
  Range range;
  range.range_m = fit.line.normal.dot(fit.line.centre) / incidence;
  if (range.range_m < geometry_.range_m(ridge.begin) || range.range_m > geometry_.range_m(ridge.end))
    return std::nullopt;
  const Eigen::Vector2d along(-fit.line.normal.y(), fit.line.normal.x());
  const double lever_m = along.dot(range.range_m * beam - fit.line.centre);
  range.sigma_m = fit.scatter_m / std::abs(incidence) *
                  std::sqrt((1 + lever_m * lever_m / fit.line.alongVariance_m2) / std::max(1.0, fit.independent));
  const double length_m = (ridge.end - ridge.begin) * geometry_.rangeResolution_m;
  if (range.sigma_m > length_m / std::sqrt(12.0)) return std::nullopt;
  return range;
}

}  // namespace s2s::sonar
