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

/// A leading-edge return of one beam: the surface lies somewhere on the arc of this range and bearing.
struct LineReturn {
  float range_m = 0;
  float bearing_rad = 0;
  float intensity = 0;
  float sigma_m = 0;  ///< standard deviation of the range
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
  Zero = 0,        ///< in the imaging plane, as the paper has it
  Seabed = 1,      ///< where the arc meets the seabed known from the vertical profile and stereo points
  Wall = 2,        ///< where it meets a wall known from LiDAR, stereo points or the vertical profile
  LowestPoint = 3  ///< nothing known: where a level seabed would be met first, the lowest point of the arc
};

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
  std::uint16_t intensityHalf = 0, rangeSigmaHalf = 0;
  std::int16_t elevation = 0;
  ElevationSource source = ElevationSource::Zero;
  std::uint8_t sigmaCode = 0;  ///< standard deviation of the point, 4 % steps from 1 mm up (see `encodeSigma`)
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
  std::vector<PackedPoint> points;
};

struct StoredLineScan {
  ScanPose pose;
  core::Isometry T_vehicle_sonar = core::Isometry::Identity();
  float verticalAperture_rad = 0, bearingSigma_rad = 0;
  obs::BearingModel bearingModel = obs::BearingModel::Azimuth;
  std::vector<PackedReturn> returns;
};

}  // namespace s2s::map
