#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/obs/CObservationLidarSweep.h"

namespace s2s::obs {

/// Turns pixels of LiDAR sweeps into points in the sensor's frame. The tables are made once for a sensor and kept as
/// long as sweeps come with the same geometry, so one projector serves a whole survey.
class SweepProjector {
 public:
  /// Makes the tables if the sweep's geometry differs from that of the last call. Call before `point`.
  void prepare(const CObservationLidarSweep& sweep);

  /// p_sensor of a pixel for a raw range of the sweep given to `prepare`; `rangeCounts` must not be zero.
  Eigen::Vector3f point(std::size_t row, std::size_t column, std::uint32_t rangeCounts) const {
    const Eigen::Vector3f& a = rowTable_[row];
    const Eigen::Vector2f& c = columnTable_[column];
    // cos/sin(azimuth + beamAzimuth) by the addition theorem: a = (cos alt cos az, cos alt sin az, sin alt)
    const float r = static_cast<float>(rangeCounts) * resolution_m_ - originDistance_m_;
    const Eigen::Vector3f p_lidar(r * (a.x() * c.x() - a.y() * c.y()) + originOffset_m_ * c.x(),
                                  r * (a.x() * c.y() + a.y() * c.x()) + originOffset_m_ * c.y(),
                                  r * a.z() + originHeight_m_);
    return R_sensor_lidar_ * p_lidar + t_sensor_lidar_;
  }

 private:
  std::vector<float> altitude_, azimuth_, columnAzimuth_;  // geometry the tables were made for
  std::vector<Eigen::Vector3f> rowTable_;
  std::vector<Eigen::Vector2f> columnTable_;
  float resolution_m_ = 0, originOffset_m_ = 0, originHeight_m_ = 0, originDistance_m_ = 0;
  Eigen::Matrix3f R_sensor_lidar_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f t_sensor_lidar_ = Eigen::Vector3f::Zero();
};

}  // namespace s2s::obs
