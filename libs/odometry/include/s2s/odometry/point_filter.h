#pragma once

#include <Eigen/Core>
#include <optional>

#include "s2s/core/transform.h"
#include "s2s/odometry/options.h"

namespace s2s::odometry {

/// Tells usable returns from those out of range and those on the vessel itself.
class PointFilter {
 public:
  enum class Verdict { keep, outOfRange, ownHull };

  /// @throws core::ConfigError if the hull box has not six numbers or its corners are in the wrong order
  PointFilter(const ScanOptions& options, const core::Isometry& T_vehicle_sensor);

  /// Not finite counts as out of range.
  Verdict judge(const Eigen::Vector3f& p_sensor) const {
    const float range2 = p_sensor.squaredNorm();
    if (!(range2 >= minRange2_ && range2 <= maxRange2_)) return Verdict::outOfRange;
    if (hasHull_) {
      const Eigen::Array3f p = (R_vehicle_sensor_ * p_sensor + t_vehicle_sensor_).array();
      if ((p >= hullMin_).all() && (p <= hullMax_).all()) return Verdict::ownHull;
    }
    return Verdict::keep;
  }

 private:
  float minRange2_, maxRange2_;
  bool hasHull_ = false;
  Eigen::Array3f hullMin_ = Eigen::Array3f::Zero(), hullMax_ = Eigen::Array3f::Zero();
  Eigen::Matrix3f R_vehicle_sensor_;
  Eigen::Vector3f t_vehicle_sensor_;
};

}  // namespace s2s::odometry
