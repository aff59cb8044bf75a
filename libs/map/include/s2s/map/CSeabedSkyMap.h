#pragma once

#include <mrpt/maps/CMetricMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/math/TBoundingBox.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "s2s/map/keyframes.h"
#include "s2s/map/line_scan_resolver.h"
#include "s2s/map/map_point.h"
#include "s2s/map/options.h"
#include "s2s/map/scan.h"
#include "s2s/map/voxel_thinner.h"

namespace s2s::map {

struct NearestCache;
std::shared_ptr<NearestCache> makeNearestCache();
class PingPairer;

/// One map from the seabed to the sky: layers of points (LiDAR, sonar stereo, line-scans of two sonars) that hang on
/// the keyframes of a pose graph, at and between them (paper, section "Map Generation").
///
/// Each scan keeps its points in the vehicle's frame at its own time together with the odometry's pose; where it is in
/// the map follows from the keyframes (`Keyframes::poseAt`). So a graph update moves every point and reads no data
/// again. A line-scan return keeps range and bearing, and its elevation is decided by a LineScanResolver.
///
/// Programs that know the keyframes use `addKeyframe`, `insertScan`, `insertLineScan` and `setKeyframePoses`. MRPT's
/// own programs call `insertObservation(observation, robotPose)`: each insertion is then a keyframe of its own.
///
/// Frame: `map`, z up. Not thread-safe, except for concurrent calls of const functions.
class CSeabedSkyMap : public mrpt::maps::CMetricMap {
  DEFINE_SERIALIZABLE(CSeabedSkyMap, s2s::map)

 public:
  CSeabedSkyMap();
  explicit CSeabedSkyMap(const MapOptions& options);
  /// Deep copies; observers of the original are not taken along.
  CSeabedSkyMap(const CSeabedSkyMap& other);
  CSeabedSkyMap& operator=(const CSeabedSkyMap& other);

  const MapOptions& options() const { return options_; }

  /// @name Keyframes
  /// @{
  /// @return false if the id is taken already: nothing is added then
  bool addKeyframe(const Keyframe& keyframe);
  /// Moves the map: new T_map_vehicle by keyframe id. Elevations of line-scans stay until `resolveLineScans`.
  /// @return number of ids found
  std::size_t setKeyframePoses(const std::map<std::uint64_t, core::Isometry>& T_map_vehicle);
  const std::vector<Keyframe>& keyframes() const { return keyframes_.all(); }
  /// T_map_vehicle at a time where the odometry has `T_odom_vehicle` (see Keyframes::poseAt).
  core::Isometry poseAt(core::TimeNs time, const core::Isometry& T_odom_vehicle) const;
  /// @}

  /// @name Insertion
  /// @{
  /// Points in the vehicle's frame at `time`; those that are not finite are dropped, and the LiDAR layer is thinned and
  /// gated by range (InsertionOptions). Keyframes around it may come later.
  /// @return number of points kept
  std::size_t insertScan(Layer layer, core::TimeNs time, const core::Isometry& T_odom_vehicle,
                         const std::vector<ScanPoint>& points);
  /// The leading edge of a ping of one of the line-scan layers; elevations are decided at once by the evidence so far.
  /// @return number of returns kept
  std::size_t insertLineScan(Layer layer, core::TimeNs time, const core::Isometry& T_odom_vehicle,
                             const LineScan& scan);
  /// Gathers the evidence anew from all scans at their present poses and decides all elevations again. To be called
  /// when poses have moved, and at the end of a survey: early arcs then profit from what came later.
  void resolveLineScans();
  /// @}

  /// @name Content
  /// @{
  std::size_t pointCount(Layer layer) const;
  std::size_t pointCount() const;
  /// Calls `visit` for every point of a layer, in order of insertion, at its present place in the map.
  void forEachPoint(Layer layer, const std::function<void(const MapPoint&)>& visit) const;
  /// Nothing if the map is empty.
  std::optional<mrpt::math::TBoundingBox> boundingBox() const;
  std::optional<mrpt::math::TBoundingBox> boundingBox(Layer layer) const;
  /// The seabed as estimated from all sonar points at their present places. It grows with every insertion; scans that a
  /// graph update has moved are taken out and put in again.
  const SurfaceEstimator& surface() const { return surface_; }
  /// The walls that sonars have met, likewise.
  const WallEstimator& walls() const { return walls_; }
  /// Where the aperture of the horizontal sonar ends as the survey tells, at negative and at positive elevations.
  const std::array<ApertureEnd, 2>& apertureEnds() const { return resolver_.ends(); }
  /// Number of line-scan points by the way their elevation was decided.
  std::array<std::size_t, kElevationSources> elevationSources(Layer layer) const;
  /// Bytes that the points take.
  std::size_t memory_bytes() const;
  /// @}

  /// @name MRPT's map interface
  /// @{
  bool isEmpty() const override { return pointCount() == 0; }
  std::string asString() const override;
  /// Writes `prefix_<layer>.txt` (x y z intensity sigma_m time) for each layer that has points and `prefix.3Dscene`.
  /// @throws core::OutputError
  void saveMetricMapRepresentationToFile(const std::string& prefix) const override;
  /// One coloured cloud a layer, named after it.
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const override;
  /// The LiDAR layer, thinned (LikelihoodOptions); made anew after the map has changed.
  const mrpt::maps::CSimplePointsMap* getAsSimplePointsMap() const override;
  void determineMatching2D(const mrpt::maps::CMetricMap* otherMap, const mrpt::poses::CPose2D& otherMapPose,
                           mrpt::tfest::TMatchingPairList& correspondences, const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& extraResults) const override;
  void determineMatching3D(const mrpt::maps::CMetricMap* otherMap, const mrpt::poses::CPose3D& otherMapPose,
                           mrpt::tfest::TMatchingPairList& correspondences, const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& extraResults) const override;
  float compute3DMatchingRatio(const mrpt::maps::CMetricMap* otherMap, const mrpt::poses::CPose3D& otherMapPose,
                               const mrpt::maps::TMatchingRatioParams& params) const override;
  float squareDistanceToClosestCorrespondence(float x0, float y0) const override;
  /// @}

 private:
  void internal_clear() override;
  bool internal_insertObservation(const mrpt::obs::CObservation& observation,
                                  const std::optional<const mrpt::poses::CPose3D>& robotPose) override;
  double internal_computeObservationLikelihood(const mrpt::obs::CObservation& observation,
                                               const mrpt::poses::CPose3D& takenFrom) const override;
  bool internal_canComputeObservationLikelihood(const mrpt::obs::CObservation& observation) const override;

  /// The thinned LiDAR layer for matching and likelihood.
  const mrpt::maps::CSimplePointsMap& nearestMap() const;

  core::Isometry mapPose(const ScanPose& pose) const;
  ScanPose addOwnKeyframe(const mrpt::obs::CObservation& observation,
                          const std::optional<const mrpt::poses::CPose3D>& robotPose, Layer layer);
  std::size_t store(const ScanPose& pose, const std::vector<ScanPoint>& points);
  std::size_t store(const ScanPose& pose, const LineScan& scan);
  void gatherEvidence(const StoredScan& scan);
  void resolve(StoredLineScan& scan);
  void countReturns(const StoredLineScan& scan);
  void visit(const StoredScan& scan, const core::Isometry& T_map_vehicle,
             const std::function<void(const MapPoint&)>& visit) const;
  void visit(const StoredLineScan& scan, const core::Isometry& T_map_vehicle,
             const std::function<void(const MapPoint&)>& visit) const;
  /// Enters a scan into the surfaces where it is now, after taking it out where it was.
  template <class Scan>
  void enterIntoSurface(Scan& scan);
  /// Lets the wall estimator know of the walls that a ping's returns were found to lie on.
  void learnWalls(const StoredScan&) {}
  void learnWalls(const StoredLineScan& scan);
  void rebuildSurface();
  bool insertPing(const obs::CObservationImagingSonar& ping,
                  const std::optional<const mrpt::poses::CPose3D>& robotPose);
  /// Forgets what was derived from the present content.
  void touch();
  /// Counts, evidence and the state of the thinning, from the scans as they are.
  void rebuildDerived();

  MapOptions options_;
  Keyframes keyframes_;
  std::vector<StoredScan> scans_;
  std::vector<StoredLineScan> lineScans_;
  std::array<std::size_t, kLayers.size()> counts_{};
  VoxelThinner thinner_;
  LineScanResolver resolver_;
  SurfaceEstimator surface_;
  WallEstimator walls_;
  std::shared_ptr<NearestCache> nearest_ = makeNearestCache();
  std::shared_ptr<PingPairer> pairer_;  // made with the first ping that MRPT inserts

  MAP_DEFINITION_START(CSeabedSkyMap)
  s2s::map::MapOptions options;
  MAP_DEFINITION_END(CSeabedSkyMap)
};

}  // namespace s2s::map
