#include "s2s/odometry/point_filter.h"

#include "s2s/core/error.h"

namespace s2s::odometry {

PointFilter::PointFilter(const ScanOptions& options, const core::Isometry& T_vehicle_sensor)
    : minRange2_(static_cast<float>(options.minRange_m * options.minRange_m)),
      maxRange2_(static_cast<float>(options.maxRange_m * options.maxRange_m)),
      R_vehicle_sensor_(T_vehicle_sensor.linear().cast<float>()),
      t_vehicle_sensor_(T_vehicle_sensor.translation().cast<float>()) {
  const auto& box = options.hullBox;
  if (box.empty()) return;
  if (box.size() != 6)
    throw core::ConfigError("the hull box has " + std::to_string(box.size()) + " numbers instead of six", "hull_box",
                            "give x y z of the least corner, then x y z of the greatest, in metres, or nothing");
  for (int axis = 0; axis < 3; ++axis) {
    hullMin_[axis] = static_cast<float>(box[axis]);
    hullMax_[axis] = static_cast<float>(box[axis + 3]);
  }
  if ((hullMin_ > hullMax_).any())
    throw core::ConfigError("the hull box's first corner lies beyond its second", "hull_box",
                            "give x y z of the least corner first");
  hasHull_ = true;
}

}  // namespace s2s::odometry
