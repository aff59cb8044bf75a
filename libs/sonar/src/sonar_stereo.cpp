#include "s2s/sonar/sonar_stereo.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace s2s::sonar {

namespace {

double rangeSigma(const FeatureOptions& options, const PingGeometry& geometry) {
  const double bin_m = geometry.rangeResolution_m;
  return std::sqrt(options.rangeSigma_m * options.rangeSigma_m + bin_m * bin_m / 12.0);
}

PairGeometry pairGeometry(const ProcessedPing& h, const ProcessedPing& v, const core::Isometry& T_h_v,
                          const SonarDevice& device_h, const SonarDevice& device_v) {
  PairGeometry pair;
  pair.T_h_v = T_h_v;
  pair.model_h = h.geometry.bearingModel;
  pair.model_v = v.geometry.bearingModel;
  pair.aperture_h_rad = h.geometry.verticalAperture_rad;
  pair.aperture_v_rad = v.geometry.verticalAperture_rad;
  pair.rangeSigma_h_m = rangeSigma(device_h.options().features, h.geometry);
  pair.rangeSigma_v_m = rangeSigma(device_v.options().features, v.geometry);
  return pair;
}

/// Features of one sonar within the overlap, with their cluster.
std::vector<Feature> findFeatures(const ProcessedPing& ping, const SonarDevice& device, const Overlap& overlap,
                                  const core::Isometry& T_h_sonar, const DbscanOptions& dbscanOptions,
                                  cv::Mat& detections) {
  detections = device.cfar().detect(ping.image, overlap.region);
  auto features = extractFeatures(ping.image, detections, ping.geometry, overlap, T_h_sonar, device.options().features);
  std::vector<Eigen::Vector2d> points;
  points.reserve(features.size());
  for (const Feature& f : features) points.push_back(planePoint(ping.geometry, f.bin, f.beam).head<2>());
  const auto labels = dbscan(points, dbscanOptions);
  for (std::size_t i = 0; i < features.size(); ++i) features[i].cluster = labels[i];
  return features;
}

/// One point from a match, or nothing if a gate rejects it.
class PointMaker {
 public:
  PointMaker(const PairGeometry& pair, const StereoOptions& options)
      : pair_(pair),
        options_(options),
        triangulator_(pair.T_h_v, pair.model_h, pair.model_v, pair.aperture_h_rad, pair.aperture_v_rad,
                      options.triangulation) {}

  void add(const FeatureMatch& match, const Feature& h, const Feature& v, StereoResult& result) const {
    const Triangulation t =
        triangulator_.fuse({h.range_m, h.bearing_rad, pair_.rangeSigma_h_m, h.bearingSigma_rad},
                           {v.range_m, match.bearing_v_rad, pair_.rangeSigma_v_m, match.bearingSigma_v_rad});
    const bool exact = options_.triangulation.fusion == Fusion::Exact;
    if (!t.converged || (exact && t.residual > options_.maxResidual)) {
      ++result.counts.outsideResidual;
      return;
    }
    if (!isInAperture(t)) {
      ++result.counts.outsideAperture;
      return;
    }
    StereoPoint point;
    point.p_h = t.p_h;
    point.covariance = t.covariance;
    if (match.spread_m > 0) {
      // The arc runs across the horizontal imaging plane.
      const Eigen::Vector3d along = arcDirection(t.p_h);
      point.covariance += match.spread_m * match.spread_m * along * along.transpose();
    }
    point.intensity = 0.5f * (h.intensity + v.intensity);
    point.residual = t.residual;
    point.bin_h = h.bin, point.beam_h = h.beam, point.bin_v = v.bin, point.beam_v = v.beam;
    if (exact && point.sigma_m() > options_.maxPointSigma_m) {
      ++result.counts.outsideSigma;
      return;
    }
    result.points.push_back(point);
  }

 private:
  bool isInAperture(const Triangulation& t) const {
    const double margin = options_.matching.apertureMargin_rad;
    return std::abs(t.elevation_h_rad) <= 0.5 * pair_.aperture_h_rad + margin &&
           std::abs(t.elevation_v_rad) <= 0.5 * pair_.aperture_v_rad + margin;
  }

  static Eigen::Vector3d arcDirection(const Eigen::Vector3d& p) {
    const Eigen::Vector3d radial = p.normalized();
    return (Eigen::Vector3d::UnitZ() - radial.z() * radial).normalized();
  }

  const PairGeometry& pair_;
  const StereoOptions& options_;
  Triangulator triangulator_;
};

std::size_t clusterCount(const std::vector<Feature>& features) {
  int count = 0;
  for (const Feature& f : features) count = std::max(count, f.cluster + 1);
  return static_cast<std::size_t>(count);
}

StereoStatus statusOf(const StereoResult& result) {
  const StereoCounts& n = result.counts;
  if (n.features_h == 0 || n.features_v == 0) return StereoStatus::NoFeatures;
  if (n.clusterPairs == 0) return StereoStatus::NoClusters;
  if (n.matches == 0) return StereoStatus::NoMatches;
  return result.points.empty() ? StereoStatus::NoPoints : StereoStatus::Ok;
}

}  // namespace

double StereoPoint::sigma_m() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, axes.eigenvalues().maxCoeff()));
}

const char* statusText(StereoStatus status) {
  switch (status) {
    case StereoStatus::Ok:
      return "ok";
    case StereoStatus::NoOverlap:
      return "the sonars' views do not overlap";
    case StereoStatus::NoFeatures:
      return "no features in the overlap of one of the sonars";
    case StereoStatus::NoClusters:
      return "no pair of clusters at the same distance";
    case StereoStatus::NoMatches:
      return "no pair of features within the gates, or only ambiguous ones";
    case StereoStatus::NoPoints:
      return "no matched pair gives a point within the gates";
  }
  return "?";
}

SonarStereo::SonarStereo(const DeviceOptions& horizontal, const DeviceOptions& vertical, const StereoOptions& options)
    : horizontal_(horizontal), vertical_(vertical), options_(options) {}

StereoResult SonarStereo::process(const obs::CObservationImagingSonar& h, const obs::CObservationImagingSonar& v,
                                  const core::Isometry& T_h_v) const {
  return process(horizontal_.process(h), vertical_.process(v), T_h_v);
}

StereoResult SonarStereo::process(const ProcessedPing& h, const ProcessedPing& v, const core::Isometry& T_h_v,
                                  StereoTrace* trace) const {
  StereoTrace local;
  StereoTrace& t = trace != nullptr ? *trace : local;
  StereoResult result;
  t.overlap_h = findOverlap(h.geometry, v.geometry, T_h_v.inverse());
  t.overlap_v = findOverlap(v.geometry, h.geometry, T_h_v);
  if (t.overlap_h.region.empty() || t.overlap_v.region.empty()) return result;

  const core::Isometry T_h_h = core::Isometry::Identity();
  t.features_h = findFeatures(h, horizontal_, t.overlap_h, T_h_h, options_.dbscan, t.detections_h);
  t.features_v = findFeatures(v, vertical_, t.overlap_v, T_h_v, options_.dbscan, t.detections_v);
  t.clusterPairs = associateClusters(describeClusters(t.features_h), describeClusters(t.features_v), options_.clusters);

  const PairGeometry pair = pairGeometry(h, v, T_h_v, horizontal_, vertical_);
  auto association = associateFeatures(t.features_h, t.features_v, t.clusterPairs, pair, options_.matching);
  t.matches = std::move(association.matches);
  result.counts = {t.features_h.size(),        t.features_v.size(),   clusterCount(t.features_h),
                   clusterCount(t.features_v), t.clusterPairs.size(), association.candidates,
                   association.ambiguous,      t.matches.size()};
  result.counts.surfaces = association.surfaces;
  const PointMaker maker(pair, options_);
  for (const FeatureMatch& match : t.matches)
    maker.add(match, t.features_h[match.horizontal], t.features_v[match.vertical], result);
  result.status = statusOf(result);
  return result;
}

}  // namespace s2s::sonar
