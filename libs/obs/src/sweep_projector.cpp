#include "s2s/obs/sweep_projector.h"

#include <cmath>

namespace s2s::obs {

void SweepProjector::prepare(const CObservationLidarSweep& sweep) {
  resolution_m_ = static_cast<float>(sweep.rangeResolution_m);
  originOffset_m_ = static_cast<float>(sweep.beamOriginOffset_m);
  originHeight_m_ = static_cast<float>(sweep.beamOriginHeight_m);
  originDistance_m_ = static_cast<float>(std::hypot(sweep.beamOriginOffset_m, sweep.beamOriginHeight_m));
  const core::Isometry T = core::toIsometry(sweep.T_sensor_lidar);
  R_sensor_lidar_ = T.linear().cast<float>();
  t_sensor_lidar_ = T.translation().cast<float>();

  if (sweep.beamAltitude_rad != altitude_ || sweep.beamAzimuth_rad != azimuth_ || rowTable_.empty()) {
    altitude_ = sweep.beamAltitude_rad;
    azimuth_ = sweep.beamAzimuth_rad;
    rowTable_.resize(altitude_.size());
    for (std::size_t row = 0; row < altitude_.size(); ++row) {
      const double altitude = altitude_[row], azimuth = azimuth_.empty() ? 0.0 : azimuth_[row];
      rowTable_[row] = Eigen::Vector3d(std::cos(altitude) * std::cos(azimuth), std::cos(altitude) * std::sin(azimuth),
                                       std::sin(altitude))
                           .cast<float>();
    }
  }
  if (sweep.columnAzimuth_rad != columnAzimuth_ || columnTable_.empty()) {
    columnAzimuth_ = sweep.columnAzimuth_rad;
    columnTable_.resize(columnAzimuth_.size());
    for (std::size_t column = 0; column < columnAzimuth_.size(); ++column) {
      const double azimuth = columnAzimuth_[column];
      columnTable_[column] = Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth)).cast<float>();
    }
  }
}

}  // namespace s2s::obs
