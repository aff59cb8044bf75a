#include "s2s/mapper/mapper_options.h"

namespace s2s::mapper {

namespace {

void addSensor(core::OptionTable& table, const std::string& name, SensorOptions& sensor, const std::string& what) {
  table.add("label_" + name, sensor.label, "Sensor label of " + what + " in the rawlog");
  table.addParsed(
      "pose_" + name, "Mounting of " + what + " on the vehicle: x y z [m] yaw pitch roll [deg], or 'recorded'",
      "six numbers, or 'recorded'",
      [&sensor](const std::string& text) {
        core::Isometry T;
        if (text == "recorded") {
          sensor.T_vehicle_sensor.reset();
          return true;
        }
        if (!core::parsePose(text, T)) return false;
        sensor.T_vehicle_sensor = T;
        return true;
      },
      [&sensor] { return sensor.T_vehicle_sensor ? core::printPose(*sensor.T_vehicle_sensor) : "recorded"; });
}

}  // namespace

core::OptionTable optionTable(MapperOptions& o) {
  core::OptionTable table;
  addSensor(table, "lidar", o.lidar, "the LiDAR");
  addSensor(table, "imu", o.imu, "the IMU");
  addSensor(table, "sonar_horizontal", o.sonarHorizontal, "the horizontal sonar");
  addSensor(table, "sonar_vertical", o.sonarVertical, "the vertical sonar");
  addSensor(table, "gnss", o.gnss, "the GNSS antenna");
  table.add("time_offset_sonar_horizontal_s", o.timeOffsetHorizontal_s,
            "How far the horizontal sonar's recorded times are late; taken off", {-1, 1});
  table.add("time_offset_sonar_vertical_s", o.timeOffsetVertical_s,
            "How far the vertical sonar's recorded times are late; taken off", {-1, 1});
  table.add(
      "sound_speed_mps", o.soundSpeed_mps,
      "True sound speed in the water; 0 takes the devices' own (pings that do not tell theirs are left as they are)",
      {0, 2000});
  table.add("stereo_pair_window_s", o.stereoPairWindow_s,
            "Pings of the two sonars no further apart than this are a stereo pair", {0.0, 1.0});
  table.add("on_water", o.onWater, "False on land: no water surface is estimated and nothing is cut at it");
  table.add("waterline_m", o.waterline_m, "Height of the water surface in the vehicle frame at rest", {-100, 100});
  table.add("water_margin_m", o.waterMargin_m, "LiDAR returns lower than this above the water are left out", {-10, 10});
  table.add("queue_capacity", o.queueCapacity, "Records that may wait between two threads", {1, 100000});
  return table;
}

}  // namespace s2s::mapper
