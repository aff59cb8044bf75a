#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/core/transform.h"
#include "s2s/map/map_point.h"
#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::map {

/// A point to be inserted, in the vehicle's frame at the scan's time (deskewed by whoever inserts it).
struct ScanPoint {
  Eigen::Vector3f p_vehicle = Eigen::Vector3f::Zero();  ///< metres
  float intensity = 0;                                  ///< LiDAR: reflectivity; sonar: preprocessed echo 0..255
  float sigma_m = 0;                                    ///< standard deviation of the position (largest axis)
};

constexpr std::uint8_t kMaxOrder = 7;

/// A return of one beam: the surface lies somewhere on the arc of this range and bearing.
struct LineReturn {
  float range_m = 0;
  float bearing_rad = 0;
  float intensity = 0;
  float sigma_m = 0;       ///< standard deviation of the range
  std::uint8_t order = 0;  ///< 0: the first of its beam, all in front of it is free; 1 ... 7: a surface behind
  bool isRidge = false;    ///< the range is that of the middle of what the beam sees of a surface, not of the nearest
};

/// The leading edge of one ping.
struct LineScan {
  core::Isometry T_vehicle_sonar = core::Isometry::Identity();
  double verticalAperture_rad = 0;  ///< full opening angle across the imaging plane
  obs::BearingModel bearingModel = obs::BearingModel::Azimuth;
  double bearingSigma_rad = 0;  ///< standard deviation of a bearing
  std::vector<LineReturn> returns;
};

/// Where on its arc a line-scan point was put, and why.
enum class ElevationSource : std::uint8_t {
  Zero = 0,         ///< in the imaging plane, as the paper has it
  Seabed = 1,       ///< where the arc meets the seabed known from stereo points and the other sonar
  Wall = 2,         ///< where it meets a wall known from LiDAR, stereo points or the vertical profile
  LowestPoint = 3,  ///< where a level seabed would be met first, and arcs from other poses have met it there too
  FreeSpace = 4,    ///< the only short part of the arc that is not free by what other pings prove
  Ambiguous = 5     ///< anywhere on the part of the arc that is not proven free; put at the lowest point of that part
};
constexpr std::size_t kElevationSources = 6;

/// Sixteen bytes a point: intensity and sigma as half floats (11 significant bits, at most 65504).
struct PackedPoint {
  float x = 0, y = 0, z = 0;
  std::uint16_t intensityHalf = 0, sigmaHalf = 0;
};
static_assert(sizeof(PackedPoint) == 16);

PackedPoint pack(const ScanPoint& point);
ScanPoint unpack(const PackedPoint& packed);

/// Sixteen bytes a line-scan return; the elevation in steps of 0.1 mrad (1 mm at 10 m).
struct PackedReturn {
  float range_m = 0, bearing_rad = 0;
  std::uint16_t intensityHalf = 0;
  std::int16_t elevation = 0;
  std::uint8_t rangeSigmaCode = 0;  ///< of the range; all three: 4 % steps from 1 mm up (see `encodeSigma`)
  std::uint8_t sigmaCode = 0;       ///< of the point
  std::uint8_t intervalCode = 0;    ///< length of the part of the arc that an ambiguous return lies on
  ElevationSource source : 4;
  std::uint8_t order : 3;    ///< of its beam, see LineReturn
  std::uint8_t isRidge : 1;  ///< likewise

  PackedReturn() : source(ElevationSource::Zero), order(0), isRidge(0) {}
  bool isAmbiguous() const { return source == ElevationSource::Ambiguous; }
  /// A return behind the first that no known surface explains is most likely none; it is kept, since the surface may
  /// become known, but it is no point of the map.
  bool isHidden() const { return order > 0 && source != ElevationSource::Wall; }
};
static_assert(sizeof(PackedReturn) == 16);

constexpr double kElevationStep_rad = 1e-4;

std::uint16_t toHalf(float value);
float fromHalf(std::uint16_t half);
/// One byte for 1 mm to some 10 m with 4 % between steps; rounds up, so that a sigma is never flattered.
std::uint8_t encodeSigma(double sigma_m);
double decodeSigma(std::uint8_t code);

/// p_sonar of a return at the elevation that was decided.
Eigen::Vector3d pointOf(const PackedReturn& packed, obs::BearingModel model);

/// What all kinds of scan have in common: when and where the vehicle was.
struct ScanPose {
  Layer layer = Layer::Lidar;
  core::TimeNs time = 0;
  core::Isometry T_odom_vehicle = core::Isometry::Identity();
  /// The keyframe it belongs to whatever its time; otherwise those around its time decide.
  std::optional<std::uint64_t> keyframe;
};

struct StoredScan {
  ScanPose pose;
  std::optional<core::Isometry> T_surface_vehicle;  ///< where it entered the map's surfaces; derived, not streamed
  std::uint64_t wallEpoch = 0;                      ///< that of the walls then
  std::vector<PackedPoint> points;
};

struct StoredLineScan {
  ScanPose pose;
  std::optional<core::Isometry> T_surface_vehicle;  ///< as above
  std::uint64_t wallEpoch = 0;
  core::Isometry T_vehicle_sonar = core::Isometry::Identity();
  float verticalAperture_rad = 0, bearingSigma_rad = 0;
  obs::BearingModel bearingModel = obs::BearingModel::Azimuth;
  std::vector<PackedReturn> returns;
};

/// A leading edge as it is stored, elevations still to be decided; returns that are not finite are dropped.
StoredLineScan toStored(const ScanPose& pose, const LineScan& scan);

}  // namespace s2s::map
