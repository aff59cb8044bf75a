// The stream form of CSeabedSkyMap, version 1 (0 had no returns behind the first): generic parameters, options as INI
// text, keyframes, scans, line-scans. What is derived (evidence, state of the thinning) is made anew from them.

#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "option_sections.h"
#include "s2s/map/CSeabedSkyMap.h"

using namespace s2s::map;  // the macro below wants the bare class name
IMPLEMENTS_SERIALIZABLE(CSeabedSkyMap, mrpt::maps::CMetricMap, s2s::map)

namespace s2s::map {

namespace {

using mrpt::serialization::CArchive;

/// More than any scan or survey holds: a count above it is damage, and must not be allocated.
constexpr std::uint32_t kMaxCount = 1u << 28;

std::uint32_t readCount(CArchive& in, const char* what) {
  const auto count = in.ReadAs<std::uint32_t>();
  if (count > kMaxCount) throw std::runtime_error(std::string(what) + ": claims " + std::to_string(count) + " entries");
  return count;
}

/// Beside a return's order: set if it is a ridge. Streams from before there was such a mark have it clear.
constexpr std::uint8_t kRidgeMark = 0x80, kOrderMask = 0x0f;

/// The upper three rows of the matrix, row by row.
void writePose(CArchive& out, const core::Isometry& T) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) out << T(r, c);
}

core::Isometry readPose(CArchive& in) {
  core::Isometry T = core::Isometry::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) in >> T(r, c);
  return T;
}

/// One member of all elements as an array.
template <class T, class Element, class Get>
void writeColumn(CArchive& out, const std::vector<Element>& elements, Get get) {
  std::vector<T> column(elements.size());
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = get(elements[i]);
  if (!column.empty()) out.WriteBufferFixEndianness(column.data(), column.size());
}

template <class T, class Element, class Set>
void readColumn(CArchive& in, std::vector<Element>& elements, Set set) {
  std::vector<T> column(elements.size());
  if (!column.empty()) in.ReadBufferFixEndianness(column.data(), column.size());
  for (std::size_t i = 0; i < column.size(); ++i) set(elements[i], column[i]);
}

void writeScanPose(CArchive& out, const ScanPose& pose) {
  out << static_cast<std::uint8_t>(pose.layer) << pose.time;
  writePose(out, pose.T_odom_vehicle);
  out << pose.keyframe.has_value() << pose.keyframe.value_or(0);
}

ScanPose readScanPose(CArchive& in) {
  ScanPose pose;
  const auto layer = in.ReadAs<std::uint8_t>();
  if (layer >= kLayers.size()) throw std::runtime_error("a scan is of layer " + std::to_string(layer));
  pose.layer = static_cast<Layer>(layer);
  in >> pose.time;
  pose.T_odom_vehicle = readPose(in);
  const auto hasKeyframe = in.ReadAs<bool>();
  const auto keyframe = in.ReadAs<std::uint64_t>();
  if (hasKeyframe) pose.keyframe = keyframe;
  return pose;
}

void writeScan(CArchive& out, const StoredScan& scan) {
  writeScanPose(out, scan.pose);
  out.WriteAs<std::uint32_t>(scan.points.size());
  writeColumn<float>(out, scan.points, [](const PackedPoint& p) { return p.x; });
  writeColumn<float>(out, scan.points, [](const PackedPoint& p) { return p.y; });
  writeColumn<float>(out, scan.points, [](const PackedPoint& p) { return p.z; });
  writeColumn<std::uint16_t>(out, scan.points, [](const PackedPoint& p) { return p.intensityHalf; });
  writeColumn<std::uint16_t>(out, scan.points, [](const PackedPoint& p) { return p.sigmaHalf; });
}

StoredScan readScan(CArchive& in) {
  StoredScan scan;
  scan.pose = readScanPose(in);
  scan.points.resize(readCount(in, "points of a scan"));
  readColumn<float>(in, scan.points, [](PackedPoint& p, float v) { p.x = v; });
  readColumn<float>(in, scan.points, [](PackedPoint& p, float v) { p.y = v; });
  readColumn<float>(in, scan.points, [](PackedPoint& p, float v) { p.z = v; });
  readColumn<std::uint16_t>(in, scan.points, [](PackedPoint& p, std::uint16_t v) { p.intensityHalf = v; });
  readColumn<std::uint16_t>(in, scan.points, [](PackedPoint& p, std::uint16_t v) { p.sigmaHalf = v; });
  return scan;
}

void writeLineScan(CArchive& out, const StoredLineScan& scan) {
  writeScanPose(out, scan.pose);
  writePose(out, scan.T_vehicle_sonar);
  out << scan.verticalAperture_rad << scan.bearingSigma_rad << static_cast<std::uint8_t>(scan.bearingModel);
  out.WriteAs<std::uint32_t>(scan.returns.size());
  writeColumn<float>(out, scan.returns, [](const PackedReturn& r) { return r.range_m; });
  writeColumn<float>(out, scan.returns, [](const PackedReturn& r) { return r.bearing_rad; });
  writeColumn<std::uint16_t>(out, scan.returns, [](const PackedReturn& r) { return r.intensityHalf; });
  writeColumn<std::uint8_t>(out, scan.returns, [](const PackedReturn& r) { return r.rangeSigmaCode; });
  writeColumn<std::int16_t>(out, scan.returns, [](const PackedReturn& r) { return r.elevation; });
  writeColumn<std::uint8_t>(out, scan.returns,
                            [](const PackedReturn& r) { return static_cast<std::uint8_t>(r.source); });
  writeColumn<std::uint8_t>(out, scan.returns, [](const PackedReturn& r) { return r.sigmaCode; });
  writeColumn<std::uint8_t>(out, scan.returns, [](const PackedReturn& r) { return r.intervalCode; });
  writeColumn<std::uint8_t>(out, scan.returns, [](const PackedReturn& r) {
    return static_cast<std::uint8_t>(r.order | (r.isRidge ? kRidgeMark : 0));
  });
}

StoredLineScan readLineScan(CArchive& in, std::uint8_t version) {
  StoredLineScan scan;
  scan.pose = readScanPose(in);
  scan.T_vehicle_sonar = readPose(in);
  in >> scan.verticalAperture_rad >> scan.bearingSigma_rad;
  scan.bearingModel = static_cast<obs::BearingModel>(in.ReadAs<std::uint8_t>() & 1u);
  scan.returns.resize(readCount(in, "returns of a line-scan"));
  readColumn<float>(in, scan.returns, [](PackedReturn& r, float v) { r.range_m = v; });
  readColumn<float>(in, scan.returns, [](PackedReturn& r, float v) { r.bearing_rad = v; });
  readColumn<std::uint16_t>(in, scan.returns, [](PackedReturn& r, std::uint16_t v) { r.intensityHalf = v; });
  if (version == 0)
    readColumn<std::uint16_t>(in, scan.returns,
                              [](PackedReturn& r, std::uint16_t v) { r.rangeSigmaCode = encodeSigma(fromHalf(v)); });
  else
    readColumn<std::uint8_t>(in, scan.returns, [](PackedReturn& r, std::uint8_t v) { r.rangeSigmaCode = v; });
  readColumn<std::int16_t>(in, scan.returns, [](PackedReturn& r, std::int16_t v) { r.elevation = v; });
  readColumn<std::uint8_t>(in, scan.returns, [](PackedReturn& r, std::uint8_t v) {
    if (v >= kElevationSources)
      throw std::runtime_error("a line-scan return has elevation source " + std::to_string(v));
    r.source = static_cast<ElevationSource>(v);
  });
  readColumn<std::uint8_t>(in, scan.returns, [](PackedReturn& r, std::uint8_t v) { r.sigmaCode = v; });
  if (version == 0) return scan;
  readColumn<std::uint8_t>(in, scan.returns, [](PackedReturn& r, std::uint8_t v) { r.intervalCode = v; });
  readColumn<std::uint8_t>(in, scan.returns, [](PackedReturn& r, std::uint8_t v) {
    r.order = std::min<std::uint8_t>(v & kOrderMask, kMaxOrder) & kMaxOrder;
    r.isRidge = (v & kRidgeMark) != 0 ? 1 : 0;
  });
  return scan;
}

void writeKeyframe(CArchive& out, const Keyframe& keyframe) {
  out << keyframe.id << keyframe.time;
  writePose(out, keyframe.T_odom_vehicle);
  writePose(out, keyframe.T_map_vehicle);
}

Keyframe readKeyframe(CArchive& in) {
  Keyframe keyframe;
  in >> keyframe.id >> keyframe.time;
  keyframe.T_odom_vehicle = readPose(in);
  keyframe.T_map_vehicle = readPose(in);
  return keyframe;
}

}  // namespace

std::uint8_t CSeabedSkyMap::serializeGetVersion() const { return 1; }

void CSeabedSkyMap::serializeTo(CArchive& out) const {
  out << genericMapParams << optionsToText(options_);
  out.WriteAs<std::uint32_t>(keyframes_.all().size());
  for (const Keyframe& keyframe : keyframes_.all()) writeKeyframe(out, keyframe);
  out.WriteAs<std::uint32_t>(scans_.size());
  for (const StoredScan& scan : scans_) writeScan(out, scan);
  out.WriteAs<std::uint32_t>(lineScans_.size());
  for (const StoredLineScan& scan : lineScans_) writeLineScan(out, scan);
}

void CSeabedSkyMap::serializeFrom(CArchive& in, std::uint8_t version) {
  switch (version) {
    case 0:
    case 1: {
      internal_clear();
      std::string text;
      in >> genericMapParams >> text;
      options_ = optionsFromText(text);
      for (auto left = readCount(in, "keyframes"); left > 0; --left) keyframes_.add(readKeyframe(in));
      for (auto left = readCount(in, "scans"); left > 0; --left) scans_.push_back(readScan(in));
      for (auto left = readCount(in, "line-scans"); left > 0; --left) lineScans_.push_back(readLineScan(in, version));
      rebuildDerived();
    } break;
    default:
      MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  }
}

void CSeabedSkyMap::rebuildDerived() {
  counts_ = {};
  thinner_.clear();
  resolver_.reset(options_.resolver);
  for (const StoredScan& scan : scans_) {
    counts_[static_cast<std::size_t>(scan.pose.layer)] += scan.points.size();
    gatherEvidence(scan);
    if (scan.pose.layer != Layer::Lidar || options_.insertion.lidarVoxel_m <= 0) continue;
    for (const PackedPoint& p : scan.points)
      thinner_.accept(scan.pose.T_odom_vehicle * Eigen::Vector3d(p.x, p.y, p.z), scan.pose.time,
                      options_.insertion.lidarVoxel_m, options_.insertion.lidarVoxelWindow_s);
  }
  for (const StoredLineScan& scan : lineScans_) {
    countReturns(scan);
    if (options_.insertion.lineElevation == LineElevation::Resolved) resolver_.addLineScan(scan, mapPose(scan.pose));
  }
  rebuildSurface();
  touch();
}

}  // namespace s2s::map
