#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/sonar/cartesian.h"
#include "s2s/sonar/cluster_association.h"
#include "s2s/sonar/dbscan.h"
#include "s2s/sonar/feature_association.h"
#include "s2s/sonar/sonar_device.h"
#include "s2s/sonar/triangulation.h"

namespace s2s::sonar {

struct StereoOptions {
  DbscanOptions dbscan;
  ClusterAssociationOptions clusters;
  FeatureAssociationOptions matching;
  TriangulationOptions triangulation;
  double maxResidual = 3.0;      ///< gate on the triangulation's residual; the exact fusion only
  double maxPointSigma_m = 0.5;  ///< gate on the largest axis of a point's uncertainty
};

/// A point of the overlap of both sonars.
struct StereoPoint {
  Eigen::Vector3d p_h = Eigen::Vector3d::Zero();               ///< in the horizontal sonar's frame, at its ping
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();        ///< [m^2], spread of ambiguous partners included
  float intensity = 0;                                         ///< mean of both echo strengths, 0..255
  double residual = 0;                                         ///< of the triangulation, in standard deviations
  std::uint32_t bin_h = 0, beam_h = 0, bin_v = 0, beam_v = 0;  ///< where it was seen

  /// Standard deviation along the worst axis.
  double sigma_m() const;
};

enum class StereoStatus { Ok, NoOverlap, NoFeatures, NoClusters, NoMatches, NoPoints };
const char* statusText(StereoStatus status);

/// What became of the data at each stage.
struct StereoCounts {
  std::size_t features_h = 0, features_v = 0;
  std::size_t clusters_h = 0, clusters_v = 0, clusterPairs = 0;
  std::size_t candidates = 0, ambiguous = 0, matches = 0;
  std::size_t surfaces = 0;  ///< horizontal clusters that a smooth surface was fitted to
  std::size_t outsideResidual = 0, outsideAperture = 0, outsideSigma = 0;
};

struct StereoResult {
  StereoStatus status = StereoStatus::NoOverlap;
  std::vector<StereoPoint> points;
  StereoCounts counts;
};

/// Intermediate results, for inspection.
struct StereoTrace {
  Overlap overlap_h, overlap_v;
  cv::Mat detections_h, detections_v;
  std::vector<Feature> features_h, features_v;
  std::vector<ClusterPair> clusterPairs;
  std::vector<FeatureMatch> matches;
};

/// Points in space from a pair of pings of two sonars with crossed imaging planes (paper, "Data Association" and "Point
/// Cloud Generation"): trim to the overlap, CFAR, DBSCAN, associate clusters, associate features, triangulate, gate.
///
/// The vessel moves between the two pings: the caller passes T_h_v from the vertical sonar at its ping to the
/// horizontal sonar at its own, motion included. Holds no state between calls.
class SonarStereo {
 public:
  SonarStereo(const DeviceOptions& horizontal, const DeviceOptions& vertical, const StereoOptions& options = {});

  /// @throws core::InputError if a ping contradicts itself
  StereoResult process(const obs::CObservationImagingSonar& h, const obs::CObservationImagingSonar& v,
                       const core::Isometry& T_h_v) const;

  /// The same for pings that are preprocessed already.
  /// @param trace if given, filled with what the stages found
  StereoResult process(const ProcessedPing& h, const ProcessedPing& v, const core::Isometry& T_h_v,
                       StereoTrace* trace = nullptr) const;

  const SonarDevice& horizontal() const { return horizontal_; }
  const SonarDevice& vertical() const { return vertical_; }
  const StereoOptions& options() const { return options_; }

 private:
  SonarDevice horizontal_, vertical_;
  StereoOptions options_;
};

}  // namespace s2s::sonar
