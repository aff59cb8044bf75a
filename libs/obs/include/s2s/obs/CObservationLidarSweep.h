#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/opengl/Visualizable.h>
#include <mrpt/poses/CPose3D.h>

#include <cstdint>
#include <string>
#include <vector>

namespace s2s::obs {

/// One sweep (revolution) of a multi-beam LiDAR, organised: `rowCount` beams by `columnCount` firing directions, with
/// the beam tables of the sensor, so that what an Ouster, Velodyne or Hesai delivers is kept and points are computed
/// on demand (`SweepProjector`).
///
/// All images are row-major: pixel (row, column) is at index row * columnCount + column.
///
/// Geometry of a pixel with range r (metres). Its beam starts on a circle of radius a = `beamOriginOffset_m` at the
/// height b = `beamOriginHeight_m`; the device counts ranges from the circle's centre, n = sqrt(a^2 + b^2) before it:
///     azimuth  = columnAzimuth_rad[column]                      (counter-clockwise, 0 = +x)
///     theta    = azimuth + beamAzimuth_rad[row]
///     p_lidar  = ((r - n) cos(altitude) cos(theta) + a cos(azimuth),
///                 (r - n) cos(altitude) sin(theta) + a sin(azimuth),
///                 (r - n) sin(altitude) + b)
///     p_sensor = T_sensor_lidar p_lidar
/// as in Ouster's manual and SDK; sensors whose beams share one origin have a = b = 0.
///
/// `timestamp` is the earliest column's time (UTC). `sensorPose` is T_vehicle_sensor.
class CObservationLidarSweep : public mrpt::obs::CObservation, public mrpt::opengl::Visualizable {
  DEFINE_SERIALIZABLE(CObservationLidarSweep, s2s::obs)

 public:
  /// One echo of each pixel. `range` counts in `rangeResolution_m`, 0 means no return. The others are empty or full.
  struct Echo {
    std::vector<std::uint32_t> range;
    std::vector<std::uint16_t> reflectivity;  ///< calibrated reflectivity as the device scales it
    std::vector<std::uint16_t> signal;        ///< photons or intensity
    std::vector<std::uint8_t> flags;          ///< the device's own mark on each return, 0 = none
  };

  std::string sensorModel;  ///< e.g. "OS-1-128"; free text
  mrpt::poses::CPose3D sensorPose;

  std::uint32_t rowCount = 0;
  std::uint32_t columnCount = 0;
  double rangeResolution_m = 0.001;
  double minRange_m = 0;  ///< nearer returns are not trusted by the device
  double maxRange_m = 0;  ///< 0 if unknown

  std::vector<Echo> echoes;                 ///< one, or two for dual-return modes (strongest first)
  std::vector<std::uint16_t> nearInfrared;  ///< ambient light; empty or one a pixel

  std::vector<float> beamAltitude_rad;  ///< one a row, positive up
  std::vector<float> beamAzimuth_rad;   ///< one a row, added to the column's azimuth; empty means zero
  double beamOriginOffset_m = 0;
  double beamOriginHeight_m = 0;
  mrpt::poses::CPose3D T_sensor_lidar;  ///< LiDAR coordinates to sensor coordinates

  std::vector<float> columnAzimuth_rad;     ///< one a column
  std::vector<std::int32_t> columnTime_ns;  ///< one a column, from `timestamp`; empty: all at `timestamp`
  std::vector<std::int32_t> rowTime_ns;     ///< added to the column's time; empty means zero (all beams fire together)
  std::vector<std::uint8_t> columnValid;    ///< one a column; empty: all valid. An invalid column was not received.

  double deviceTime_s = -1;  ///< device clock at `timestamp`; negative if `timestamp` is already that clock
  std::uint32_t frameId = 0;

  std::size_t pixelCount() const { return static_cast<std::size_t>(rowCount) * columnCount; }
  /// Time of a pixel in nanoseconds from `timestamp`.
  std::int32_t pixelTime_ns(std::size_t row, std::size_t column) const;
  /// From the earliest to the latest pixel, in seconds; columns may be stored in any order of time.
  double duration_s() const;
  bool isColumnValid(std::size_t column) const { return columnValid.empty() || columnValid[column] != 0; }
  /// Pixels of the first echo with a return.
  std::size_t returnCount() const;

  /// @throws core::InputError naming the first field whose size or value contradicts the others
  void checkConsistent() const;

  void getSensorPose(mrpt::poses::CPose3D& out) const override { out = sensorPose; }
  void setSensorPose(const mrpt::poses::CPose3D& pose) override { sensorPose = pose; }
  void getDescriptionAsText(std::ostream& o) const override;

  /// One line a sweep: sizes, duration, returns, then each row's mean range (m).
  bool exportTxtSupported() const override { return true; }
  std::string exportTxtHeader() const override;
  std::string exportTxtDataRow() const override;

  /// The points coloured by height, in the vehicle's frame.
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& o) const override;
};

}  // namespace s2s::obs
