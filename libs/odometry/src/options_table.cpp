#include "s2s/odometry/options_table.h"

namespace s2s::odometry {

namespace {

using core::atLeast;
using core::OptionTable;
using core::positive;

void addScan(OptionTable& table, ScanOptions& o) {
  table.add("min_range_m", o.minRange_m, "nearer returns are left out", atLeast(0))
      .add("max_range_m", o.maxRange_m, "farther returns are left out", positive())
      .add("row_stride", o.rowStride, "look at every n-th row of an organised sweep; 0: automatic", atLeast(0))
      .add("column_stride", o.columnStride, "look at every n-th column; 0: automatic", atLeast(0))
      .add("max_points", o.maxPoints, "returns looked at in a sweep with automatic strides", atLeast(1000))
      .addList("hull_box", o.hullBox,
               "the vessel itself in its own frame: x y z of the least corner, x y z of the greatest, m; empty: none");
}

void addImu(OptionTable& table, ImuOptions& o) {
  table.add("gyro_noise_radps_rthz", o.gyroNoise_radps_rthz, "gyro noise density", positive())
      .add("accel_noise_mps2_rthz", o.accelNoise_mps2_rthz, "accelerometer noise density", positive())
      .add("gyro_bias_walk_radps2_rthz", o.gyroBiasWalk_radps2_rthz, "random walk of the gyro's bias", atLeast(0))
      .add("accel_bias_walk_mps3_rthz", o.accelBiasWalk_mps3_rthz, "random walk of the accelerometer's bias",
           atLeast(0))
      .add("gyro_bias_sigma_radps", o.gyroBiasSigma_radps, "gyro bias to be expected at switch-on", positive())
      .add("accel_bias_sigma_mps2", o.accelBiasSigma_mps2, "accelerometer bias to be expected", positive())
      .add("gravity_mps2", o.gravity_mps2, "local gravity", {9.7, 9.9})
      .add("estimate_time_offset", o.estimateTimeOffset, "find the offset between the clocks of IMU and LiDAR")
      .add("time_offset_sigma_s", o.timeOffsetSigma_s, "offset to be expected", positive())
      .add("estimate_mounting", o.estimateMounting, "find how the IMU is turned against what its mounting says")
      .addDegrees("mounting_sigma_deg", o.mountingSigma_rad, "such a turn to be expected", positive())
      .add("imu_max_gap_s", o.maxGap_s, "longer silence of the IMU is bridged with constant velocity", positive());
}

void addMotion(OptionTable& table, MotionOptions& o) {
  table
      .add("acceleration_mps2_rthz", o.acceleration_mps2_rthz,
           "how fast the speed changes where no IMU tells: density of white acceleration", positive())
      .add("angular_acceleration_radps2_rthz", o.angularAcceleration_radps2_rthz, "the same of the turn rate",
           positive())
      .add("initial_speed_sigma_mps", o.initialSpeedSigma_mps, "speed to be expected at the start", positive())
      .add("initial_turn_rate_sigma_radps", o.initialTurnRateSigma_radps, "turn rate to be expected at the start",
           positive());
}

void addMap(OptionTable& table, PlaneMapOptions& o) {
  table.add("map_voxel_m", o.voxel_m, "edge of the map's finest voxels; each level above doubles it", positive())
      .add("map_levels", o.levels, "number of voxel sizes", {1, 6})
      .add("map_min_points", o.minPoints, "points a voxel needs for a plane", atLeast(3))
      .add("map_max_points", o.maxPoints, "points after which a voxel is settled", atLeast(3))
      .add("map_max_thickness_m", o.maxThickness_m, "standard deviation across a plane; thicker is no plane",
           positive())
      .add("map_radius_m", o.radius_m, "voxels farther from the vehicle are forgotten", positive());
}

void addRegistration(OptionTable& table, RegistrationOptions& o) {
  table.add("scan_voxel_m", o.scanVoxel_m, "one point in each such cube is registered", positive())
      .add("insert_voxel_m", o.mapVoxel_m, "one point in each such cube enters the map", positive())
      .add("range_sigma_m", o.rangeSigma_m, "noise of a range", positive())
      .addDegrees("angle_sigma_deg", o.angleSigma_rad, "noise of a direction", atLeast(0))
      .add("max_iterations", o.maxIterations, "of a registration", atLeast(1))
      .add("min_matches", o.minMatches, "points on known planes below which a scan is not registered", atLeast(6))
      .add("gate_sigma", o.gateSigma, "matches further off than this many standard deviations are left out", positive())
      .add("stop_translation_m", o.stopTranslation_m, "a smaller step ends the iterations", positive())
      .addDegrees("stop_rotation_deg", o.stopRotation_rad, "and a smaller rotation", positive())
      .add("degeneracy_ratio", o.degeneracyRatio,
           "directions known less than this many times what the noise of the normals pretends are held by the motion "
           "model",
           atLeast(0))
      .add("correlation", o.correlation, "this many neighbouring residuals count as one independent", atLeast(1));
}

void addWater(OptionTable& table, WaterOptions& o) {
  table.add("heave_prior", o.heavePrior, "the vessel floats, so its height stays near the waterline")
      .add("heave_sigma_m", o.heaveSigma_m,
           "most that the vessel's height may scatter about the waterline; how much it does is learnt", positive())
      .add("heave_time_s", o.heaveTime_s, "over which one heave resembles the next", positive())
      .addDegrees("lean_sigma_deg", o.leanSigma_rad, "how far the vessel leans, where no IMU tells", positive())
      .add("level_walk_m_rts", o.levelWalk_m_rts, "random walk of the water's level (tide)", atLeast(0))
      .add("velocity_prior", o.velocityPrior, "the vessel goes ahead, slowly, and hardly sideways (needs an IMU)")
      .add("speed_sigma_mps", o.speedSigma_mps, "standard deviation of the speed ahead", positive())
      .add("drift_sigma_mps", o.driftSigma_mps, "standard deviation of the speed across", positive())
      .add("speed_time_s", o.speedTime_s, "over which one speed resembles the next", positive())
      .add("level_give_up_sigma", o.giveUpSigma,
           "if the height stays this many standard deviations off, the water has moved (a lock)", positive());
}

void addSeabed(OptionTable& table, SeabedOptions& o) {
  table.add("seabed", o.enabled, "register what the sonars see beside what the LiDAR sees")
      .add("seabed_voxel_m", o.map.voxel_m, "edge of the finest voxels of the seabed's map", positive())
      .add("seabed_map_max_thickness_m", o.map.maxThickness_m,
           "standard deviation across a plane of the seabed's map; thicker is no plane", positive())
      .add("seabed_map_radius_m", o.map.radius_m, "voxels of the seabed's map farther away are forgotten", positive())
      .add("seabed_point_voxel_m", o.pointVoxel_m, "one acoustic point in each such cube is used", positive())
      .add("seabed_least_sigma_m", o.leastSigma_m, "no acoustic point is believed better than this", positive())
      .add("seabed_min_matches", o.minMatches, "acoustic points on known planes below which they are not registered",
           atLeast(6))
      .add("seabed_correlation", o.correlation, "this many neighbouring acoustic residuals count as one independent",
           atLeast(1));
}

}  // namespace

core::OptionTable optionTable(OdometryOptions& o) {
  OptionTable table;
  table
      .addChoice<ImuUse>("imu", o.imuUse, {{"automatic", ImuUse::automatic}, {"never", ImuUse::never}},
                         "use of the IMU: automatic takes it if there is one")
      .add("initialisation_s", o.initialisation_s, "stretch of the record looked at before the first pose", positive())
      .add("imu_max_delay_s", o.maxImuDelay_s, "how long a scan waits for missing IMU samples", atLeast(0));
  addScan(table, o.scan);
  addImu(table, o.imu);
  addMotion(table, o.motion);
  addMap(table, o.map);
  addRegistration(table, o.registration);
  addWater(table, o.water);
  addSeabed(table, o.seabed);
  return table;
}

}  // namespace s2s::odometry
