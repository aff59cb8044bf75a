#include "s2s/map/CSeabedSkyMap.h"

#include <cmath>
#include <sstream>

#include "nearest_cache.h"
#include "ping_pairer.h"

namespace s2s::map {

namespace {

/// A scan that a graph update moved by less stays where it is in the surface until all is settled at the end (metres,
/// radians times a usual range of 5 m): below what a cell is uncertain by, and most updates move most scans by less.
constexpr double kSurfaceMotion_m = 0.02;

bool isNear(const core::Isometry& a, const core::Isometry& b) {
  constexpr double kRange_m = 5;
  return (a.translation() - b.translation()).norm() + kRange_m * (a.linear() - b.linear()).norm() < kSurfaceMotion_m;
}

}  // namespace

CSeabedSkyMap::CSeabedSkyMap() { resolver_.reset(options_.resolver); }

CSeabedSkyMap::CSeabedSkyMap(const MapOptions& options)
    : options_(options), surface_(options.surface), walls_(options.walls) {
  resolver_.reset(options_.resolver);
}

CSeabedSkyMap::CSeabedSkyMap(const CSeabedSkyMap& other) : CSeabedSkyMap(other.options_) { *this = other; }

CSeabedSkyMap& CSeabedSkyMap::operator=(const CSeabedSkyMap& other) {
  if (this == &other) return *this;
  genericMapParams = other.genericMapParams;
  options_ = other.options_;
  keyframes_ = other.keyframes_;
  scans_ = other.scans_;
  lineScans_ = other.lineScans_;
  counts_ = other.counts_;
  thinner_ = other.thinner_;
  resolver_ = other.resolver_;
  rebuildSurface();
  pairer_ = other.pairer_ ? std::make_shared<PingPairer>(*other.pairer_) : nullptr;
  touch();
  return *this;
}

bool CSeabedSkyMap::addKeyframe(const Keyframe& keyframe) {
  touch();
  return keyframes_.add(keyframe);
}

std::size_t CSeabedSkyMap::setKeyframePoses(const std::map<std::uint64_t, core::Isometry>& T_map_vehicle) {
  touch();
  const std::size_t found = keyframes_.setPoses(T_map_vehicle);
  // Where walls come to stand must be known before the LiDAR's points are put there.
  for (const StoredLineScan& scan : lineScans_)
    if (scan.T_surface_vehicle && !isNear(*scan.T_surface_vehicle, mapPose(scan.pose))) learnWalls(scan);
  for (StoredScan& scan : scans_) enterIntoSurface(scan);
  for (StoredLineScan& scan : lineScans_) enterIntoSurface(scan);
  return found;
}

core::Isometry CSeabedSkyMap::poseAt(core::TimeNs time, const core::Isometry& T_odom_vehicle) const {
  return keyframes_.poseAt(time, T_odom_vehicle, options_.insertion.interpolation);
}

core::Isometry CSeabedSkyMap::mapPose(const ScanPose& pose) const {
  return pose.keyframe ? keyframes_.poseFrom(*pose.keyframe, pose.T_odom_vehicle)
                       : poseAt(pose.time, pose.T_odom_vehicle);
}

void CSeabedSkyMap::touch() { nearest_ = makeNearestCache(); }

std::size_t CSeabedSkyMap::insertScan(Layer layer, core::TimeNs time, const core::Isometry& T_odom_vehicle,
                                      const std::vector<ScanPoint>& points) {
  return store({layer, time, T_odom_vehicle, std::nullopt}, points);
}

std::size_t CSeabedSkyMap::insertLineScan(Layer layer, core::TimeNs time, const core::Isometry& T_odom_vehicle,
                                          const LineScan& scan) {
  return store({layer, time, T_odom_vehicle, std::nullopt}, scan);
}

std::size_t CSeabedSkyMap::store(const ScanPose& pose, const std::vector<ScanPoint>& points) {
  const InsertionOptions& options = options_.insertion;
  const bool isLidar = pose.layer == Layer::Lidar;
  const double min2 = options.lidarMinRange_m * options.lidarMinRange_m;
  const double max2 = options.lidarMaxRange_m * options.lidarMaxRange_m;
  StoredScan scan;
  scan.pose = pose;
  for (const ScanPoint& point : points) {
    if (!point.p_vehicle.allFinite()) continue;
    const double range2 = point.p_vehicle.squaredNorm();
    if (isLidar && (range2 < min2 || range2 > max2)) continue;
    if (isLidar && options.lidarVoxel_m > 0 &&
        !thinner_.accept(pose.T_odom_vehicle * point.p_vehicle.cast<double>(), pose.time, options.lidarVoxel_m,
                         options.lidarVoxelWindow_s))
      continue;
    scan.points.push_back(pack(point));
  }
  if (scan.points.empty()) return 0;
  scan.points.shrink_to_fit();
  counts_[static_cast<std::size_t>(pose.layer)] += scan.points.size();
  gatherEvidence(scan);
  enterIntoSurface(scan);
  scans_.push_back(std::move(scan));
  touch();
  return scans_.back().points.size();
}

std::size_t CSeabedSkyMap::store(const ScanPose& pose, const LineScan& scan) {
  StoredLineScan stored = toStored(pose, scan);
  if (stored.returns.empty()) return 0;
  if (options_.insertion.lineElevation == LineElevation::Resolved) resolver_.observeEnds(stored, mapPose(stored.pose));
  resolve(stored);
  countReturns(stored);
  enterIntoSurface(stored);
  lineScans_.push_back(std::move(stored));
  touch();
  return lineScans_.back().returns.size();
}

void CSeabedSkyMap::gatherEvidence(const StoredScan& scan) {
  if (options_.insertion.lineElevation != LineElevation::Resolved) return;
  if (scan.pose.layer != Layer::Lidar && scan.pose.layer != Layer::Stereo) return;
  const core::Isometry T_map_vehicle = mapPose(scan.pose);
  const double reach2 = options_.resolver.lidarWallRange_m * options_.resolver.lidarWallRange_m;
  for (const PackedPoint& packed : scan.points) {
    const ScanPoint point = unpack(packed);
    const Eigen::Vector3d p_map = T_map_vehicle * point.p_vehicle.cast<double>();
    if (scan.pose.layer == Layer::Stereo)
      resolver_.addStereoPoint(p_map, point.sigma_m);
    else if (point.p_vehicle.z() >= options_.waterline_m &&
             point.p_vehicle.z() <= options_.waterline_m + options_.resolver.lidarWallBand_m &&
             point.p_vehicle.head<2>().squaredNorm() <= reach2)
      resolver_.addWallPoint(p_map);
  }
}

void CSeabedSkyMap::resolve(StoredLineScan& scan) {
  if (options_.insertion.lineElevation != LineElevation::Resolved) return LineScanResolver::setZero(scan);
  const core::Isometry T_map_vehicle = mapPose(scan.pose);
  resolver_.resolve(scan, T_map_vehicle, LineScanResolver::Pass::First);
  resolver_.addLineScan(scan, T_map_vehicle);
}

void CSeabedSkyMap::resolveLineScans() {
  resolver_.reset(options_.resolver);
  for (const StoredScan& scan : scans_) gatherEvidence(scan);
  // The vertical sonar first: its profiles are evidence for the horizontal one wherever in time they come. Then both
  // again, now that all evidence is there.
  for (StoredLineScan& scan : lineScans_)
    if (scan.pose.layer == Layer::LineVertical) resolve(scan);
  if (options_.insertion.lineElevation == LineElevation::Resolved)
    for (const StoredLineScan& scan : lineScans_) resolver_.observeEnds(scan, mapPose(scan.pose));
  for (StoredLineScan& scan : lineScans_)
    if (scan.pose.layer != Layer::LineVertical) resolve(scan);
  if (options_.insertion.lineElevation == LineElevation::Resolved)
    for (StoredLineScan& scan : lineScans_) resolver_.resolve(scan, mapPose(scan.pose));
  for (const Layer layer : {Layer::LineHorizontal, Layer::LineVertical}) counts_[static_cast<std::size_t>(layer)] = 0;
  for (const StoredScan& scan : scans_)
    if (scan.pose.layer != Layer::Lidar && scan.pose.layer != Layer::Stereo)
      counts_[static_cast<std::size_t>(scan.pose.layer)] += scan.points.size();
  for (const StoredLineScan& scan : lineScans_) countReturns(scan);
  rebuildSurface();
  touch();
}

void CSeabedSkyMap::countReturns(const StoredLineScan& scan) {
  for (const PackedReturn& r : scan.returns) counts_[static_cast<std::size_t>(scan.pose.layer)] += r.isHidden() ? 0 : 1;
}

std::size_t CSeabedSkyMap::pointCount(Layer layer) const { return counts_[static_cast<std::size_t>(layer)]; }

std::size_t CSeabedSkyMap::pointCount() const {
  std::size_t sum = 0;
  for (const std::size_t count : counts_) sum += count;
  return sum;
}

void CSeabedSkyMap::forEachPoint(Layer layer, const std::function<void(const MapPoint&)>& visitor) const {
  for (const StoredScan& scan : scans_)
    if (scan.pose.layer == layer) visit(scan, mapPose(scan.pose), visitor);
  for (const StoredLineScan& scan : lineScans_)
    if (scan.pose.layer == layer) visit(scan, mapPose(scan.pose), visitor);
}

void CSeabedSkyMap::visit(const StoredScan& scan, const core::Isometry& T_map_vehicle,
                          const std::function<void(const MapPoint&)>& visitor) const {
  MapPoint out;
  out.layer = scan.pose.layer;
  out.time = scan.pose.time;
  for (const PackedPoint& packed : scan.points) {
    const ScanPoint point = unpack(packed);
    out.p_map = T_map_vehicle * point.p_vehicle.cast<double>();
    out.intensity = point.intensity;
    out.sigma_m = point.sigma_m;
    visitor(out);
  }
}

void CSeabedSkyMap::visit(const StoredLineScan& scan, const core::Isometry& T_map_vehicle,
                          const std::function<void(const MapPoint&)>& visitor) const {
  const core::Isometry T_map_sonar = T_map_vehicle * scan.T_vehicle_sonar;
  MapPoint out;
  out.layer = scan.pose.layer;
  out.time = scan.pose.time;
  for (const PackedReturn& r : scan.returns) {
    if (r.isHidden()) continue;
    out.p_map = T_map_sonar * pointOf(r, scan.bearingModel);
    out.intensity = fromHalf(r.intensityHalf);
    out.sigma_m = static_cast<float>(decodeSigma(r.sigmaCode));
    out.isWall = r.source == ElevationSource::Wall;
    out.interval_m = r.isAmbiguous() ? static_cast<float>(decodeSigma(r.intervalCode)) : 0;
    visitor(out);
  }
}

template <class Scan>
void CSeabedSkyMap::enterIntoSurface(Scan& scan) {
  const core::Isometry T_map_vehicle = mapPose(scan.pose);
  if (scan.T_surface_vehicle) {
    if (isNear(*scan.T_surface_vehicle, T_map_vehicle)) return;
    visit(scan, *scan.T_surface_vehicle, [&](const MapPoint& p) {
      surface_.remove(p);
      walls_.remove(p, scan.wallEpoch);
    });
  }
  learnWalls(scan);
  scan.wallEpoch = walls_.epoch();
  visit(scan, T_map_vehicle, [this](const MapPoint& p) {
    surface_.add(p);
    walls_.add(p);
  });
  scan.T_surface_vehicle = T_map_vehicle;
}

void CSeabedSkyMap::learnWalls(const StoredLineScan& scan) {
  const core::Isometry T_map_vehicle = mapPose(scan.pose);
  const Eigen::Vector2d eye = T_map_vehicle.translation().head<2>();
  visit(scan, T_map_vehicle, [&](const MapPoint& p) {
    const Eigen::Vector2d place = p.p_map.head<2>();
    if (!p.isWall || walls_.knows(place)) return;
    const auto wall = resolver_.wallNear(place.x(), place.y());
    if (!wall) return;
    // The evidence stays where it was until all is resolved again; a ping that was moved far off takes its own place.
    const double here_m = wall->normal.dot(place);
    const double wall_m = std::abs(here_m - wall->offset_m) <= options_.walls.reach_m ? wall->offset_m : here_m;
    const double side = wall->normal.dot(eye) < wall_m ? -1 : 1;
    walls_.learn(place, side * wall->normal, side * wall_m);
  });
}

void CSeabedSkyMap::rebuildSurface() {
  surface_ = SurfaceEstimator(options_.surface);
  walls_ = WallEstimator(options_.walls);
  for (const StoredLineScan& scan : lineScans_) learnWalls(scan);
  for (StoredScan& scan : scans_) scan.T_surface_vehicle.reset();
  for (StoredLineScan& scan : lineScans_) scan.T_surface_vehicle.reset();
  for (StoredScan& scan : scans_) enterIntoSurface(scan);
  for (StoredLineScan& scan : lineScans_) enterIntoSurface(scan);
}

std::optional<mrpt::math::TBoundingBox> CSeabedSkyMap::boundingBox(Layer layer) const {
  if (pointCount(layer) == 0) return std::nullopt;
  Eigen::AlignedBox3d box;
  forEachPoint(layer, [&box](const MapPoint& point) { box.extend(point.p_map); });
  return mrpt::math::TBoundingBox({box.min().x(), box.min().y(), box.min().z()},
                                  {box.max().x(), box.max().y(), box.max().z()});
}

std::optional<mrpt::math::TBoundingBox> CSeabedSkyMap::boundingBox() const {
  std::optional<mrpt::math::TBoundingBox> all;
  for (const Layer layer : kLayers) {
    const auto box = boundingBox(layer);
    if (box) all = all ? all->unionWith(*box) : *box;
  }
  return all;
}

std::array<std::size_t, kElevationSources> CSeabedSkyMap::elevationSources(Layer layer) const {
  std::array<std::size_t, kElevationSources> counts{};
  for (const StoredLineScan& scan : lineScans_)
    if (scan.pose.layer == layer)
      for (const PackedReturn& r : scan.returns)
        if (!r.isHidden()) ++counts[static_cast<std::size_t>(r.source)];
  return counts;
}

std::size_t CSeabedSkyMap::memory_bytes() const {
  std::size_t bytes =
      scans_.capacity() * sizeof(StoredScan) + lineScans_.capacity() * sizeof(StoredLineScan) + thinner_.memory_bytes();
  for (const StoredScan& scan : scans_) bytes += scan.points.capacity() * sizeof(PackedPoint);
  for (const StoredLineScan& scan : lineScans_) bytes += scan.returns.capacity() * sizeof(PackedReturn);
  return bytes;
}

std::string CSeabedSkyMap::asString() const {
  std::ostringstream text;
  text << "Seabed-to-sky map: " << keyframes_.all().size() << " keyframes";
  for (const Layer layer : kLayers) text << ", " << pointCount(layer) << " " << layerName(layer);
  return text.str();
}

void CSeabedSkyMap::internal_clear() {
  keyframes_.clear();
  scans_.clear();
  lineScans_.clear();
  counts_ = {};
  thinner_.clear();
  resolver_.reset(options_.resolver);
  surface_.clear();
  walls_.clear();
  pairer_.reset();
  touch();
}

}  // namespace s2s::map
