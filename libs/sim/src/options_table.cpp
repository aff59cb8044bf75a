#include "s2s/sim/options_table.h"

namespace s2s::sim {

using core::atLeast;
using core::IniFile;
using core::OptionTable;
using core::positive;

OptionTable optionTable(VesselOptions& o) {
  OptionTable t;
  t.add("start_still_s", o.startStill_s, "time at rest before it gets going", atLeast(0))
      .add("lookahead_m", o.lookahead_m, "guidance aims this far ahead on the planned way", positive())
      .add("yaw_time_constant_s", o.yawTimeConstant_s, "lag of the yaw rate behind the rudder", positive())
      .addDegrees("max_yaw_rate_degps", o.maxYawRate_radps, "sharpest turn", positive())
      .add("yaw_gain_per_s", o.yawGain_perS, "commanded yaw rate per heading error", positive())
      .add("speed_time_constant_s", o.speedTimeConstant_s, "lag of the speed", positive())
      .add("turn_slowdown", o.turnSlowdown, "share of speed lost in the sharpest turn", {0, 0.95})
      .add("drift_s", o.drift_s, "sway per yaw rate and speed", {-2, 2});
  return t;
}

OptionTable optionTable(WaveOptions& o) {
  OptionTable t;
  t.add("enabled", o.enabled, "heave, roll and pitch")
      .add("significant_height_m", o.significantHeight_m, "significant wave height", atLeast(0))
      .add("peak_period_s", o.peakPeriod_s, "period of the spectrum's peak", positive())
      .add("components", o.components, "number of sinusoids", {1, 1000})
      .addDegrees("direction_deg", o.direction_rad, "the way the waves run")
      .add("roll_natural_period_s", o.rollNaturalPeriod_s, "of the vessel", positive())
      .add("roll_damping", o.rollDamping, "share of critical damping", positive())
      .add("slope_response", o.slopeResponse, "roll and pitch per wave slope", atLeast(0));
  return t;
}

OptionTable optionTable(LidarOptions& o) {
  OptionTable t;
  t.add("enabled", o.enabled, "simulate the LiDAR")
      .add("label", o.label, "sensor label")
      .addPose("pose", o.T_vehicle_sensor, "nominal mounting on the vehicle")
      .add("rows", o.rows, "beams", {1, 1024})
      .add("columns", o.columns, "firings a revolution", {8, 8192})
      .add("rate_hz", o.rate_hz, "revolutions a second", positive())
      .addDegrees("vertical_fov_deg", o.verticalFov_rad, "from the highest to the lowest beam", {0, 180})
      .add("min_range_m", o.minRange_m, "nearer returns are dropped", atLeast(0))
      .add("max_range_m", o.maxRange_m, "farther returns are dropped", positive());
  LidarEffects& e = o.effects;
  t.add("noise", e.noise, "range noise")
      .add("range_sigma_m", e.rangeSigma_m, "range noise, constant part", atLeast(0))
      .add("range_sigma_far_m_per_m", e.rangeSigmaFar_mPerM, "range noise, part growing with range", atLeast(0))
      .addDegrees("beam_divergence_deg", e.beamDivergence_rad, "full width of a beam", {0, 5})
      .add("bias", e.bias, "range bias by incidence and reflectivity")
      .add("incidence_bias_m", e.incidenceBias_m, "times 1/cos(incidence) - 1")
      .add("dark_bias_m", e.darkBias_m, "on a surface of no reflectivity")
      .add("dropouts", e.dropouts, "weak echoes are lost")
      .add("half_range_m", e.halfRange_m, "a white surface is lost every other time at this range", positive())
      .add("mixed_pixels", e.mixedPixels, "echoes merge at edges")
      .add("mixed_max_gap_m", e.mixedMaxGap_m, "echoes further apart do not merge", atLeast(0))
      .add("own_vessel", e.ownVessel, "returns from the vessel's own parts")
      .add("water_returns", e.waterReturns, "sparse returns from the water surface")
      .add("water_return_share", e.waterReturnShare, "of the beams that meet it close by", {0, 1})
      .add("water_return_range_m", e.waterReturnRange_m, "e-fold of their decrease", positive())
      .add("wave_height_sigma_m", e.waveHeightSigma_m, "scatter of their heights", atLeast(0))
      .add("water_ghosts", e.waterGhosts, "mirror images below the surface")
      .add("water_smoothness", e.waterSmoothness, "share of the surface that mirrors", {0, 1});
  return t;
}

OptionTable optionTable(ImuOptions& o) {
  OptionTable t;
  t.add("label", o.label, "sensor label")
      .addPose("pose", o.T_vehicle_imu, "mounting on the vehicle")
      .add("rate_hz", o.rate_hz, "samples a second", positive())
      .add("noise", o.noise, "false: exact derivatives of the motion")
      .add("acc_noise_density_mps2_per_rthz", o.accNoiseDensity_mps2PerRtHz, "white noise", atLeast(0))
      .add("gyro_noise_density_radps_per_rthz", o.gyroNoiseDensity_radpsPerRtHz, "white noise", atLeast(0))
      .add("acc_bias_mps2", o.accBias_mps2, "bias at switch-on, standard deviation", atLeast(0))
      .add("gyro_bias_radps", o.gyroBias_radps, "bias at switch-on, standard deviation", atLeast(0))
      .add("acc_bias_walk_mps3_per_rthz", o.accBiasWalk_mps3PerRtHz, "random walk of the bias", atLeast(0))
      .add("gyro_bias_walk_radps2_per_rthz", o.gyroBiasWalk_radps2PerRtHz, "random walk of the bias", atLeast(0))
      .add("acc_scale", o.accScale, "scale error, standard deviation", atLeast(0))
      .add("gyro_scale", o.gyroScale, "scale error, standard deviation", atLeast(0))
      .add("gravity_mps2", o.gravity_mps2, "local gravity", positive());
  return t;
}

namespace {

void addSonarDevice(OptionTable& t, SonarOptions& o) {
  t.add("enabled", o.enabled, "simulate this sonar")
      .add("label", o.label, "sensor label")
      .add("model", o.model, "name of the device")
      .addPose("pose", o.T_vehicle_sensor, "nominal mounting on the vehicle")
      .add("rate_hz", o.rate_hz, "pings a second", positive())
      .add("start_offset_s", o.startOffset_s, "time of the first ping", atLeast(0))
      .add("beams", o.beamCount, "number of beams", {2, 4096})
      .addDegrees("fan_deg", o.fan_rad, "from the first to the last beam", {1, 175})
      .addChoice("beam_spacing", o.spacing,
                 {{"uniform_sine", BeamSpacing::UniformSine}, {"uniform_angle", BeamSpacing::UniformAngle}},
                 "what the beams are evenly spaced in")
      .addDegrees("aperture_deg", o.aperture_rad, "opening across the imaging plane", {0.1, 90})
      .addChoice("bearing_model", o.bearingModel,
                 {{"azimuth", obs::BearingModel::Azimuth}, {"cone", obs::BearingModel::Cone}},
                 "half-planes of constant azimuth, or the cones of a straight array")
      .add("range_bins", o.rangeCount, "samples in range", {2, 100000})
      .add("max_range_m", o.maxRange_m, "end of the last bin", positive())
      .add("elevation_rays", o.elevationRays, "rays over the aperture, per beam", {4, 4096});
}

void addSonarPhysics(OptionTable& t, SonarOptions& o) {
  t.addChoice("elevation_pattern", o.elevationPattern,
              {{"rectangle", ElevationPattern::Rectangle},
               {"sinc", ElevationPattern::Sinc},
               {"shaped", ElevationPattern::Shaped}},
              "sensitivity across the imaging plane")
      .add("elevation_side_lobe_db", o.elevationSideLobe_db, "one way, of the shaped pattern", {-80, 0})
      .add("beam_pattern", o.beamPattern, "beams of finite width with side lobes")
      .addDegrees("beam_width_deg", o.beamWidth_rad, "-3 dB width at the fan's centre", positive())
      .add("taper", o.taper, "shading of the array: 1 none, 0.54 Hamming", {0.5, 1})
      .add("pulse_length_m", o.pulseLength_m, "-6 dB length of the pulse in range", atLeast(0))
      .add("frequency_hz", o.frequency_hz, "carrier", positive())
      .add("source_level_db", o.sourceLevel_db, "re 1 uPa at 1 m")
      .add("spreading", o.spreading, "spherical spreading")
      .add("absorption", o.absorption, "absorption by the water")
      .add("absorption_db_per_m", o.absorption_dbPerM, "one way", atLeast(0))
      .add("texture", o.texture, "patches that scatter more or less than their material")
      .add("texture_db", o.texture_db, "standard deviation of the texture", atLeast(0))
      .add("texture_length_m", o.textureLength_m, "largest wavelength of the texture", positive())
      .add("volume", o.volume, "backscatter of the water")
      .add("volume_backscatter_db", o.volumeBackscatter_db, "per cubic metre")
      .add("multipath", o.multipath, "echoes by way of the water surface")
      .add("surface_loss_db", o.surfaceLoss_db, "a bounce", atLeast(0))
      .add("noise", o.noise, "noise floor")
      .add("noise_level_db", o.noiseLevel_db, "of a pixel, re 1 uPa")
      .add("speckle", o.speckle, "interference of unresolved scatterers")
      .add("looks", o.looks, "independent looks averaged", {1, 64})
      .add("blanking_m", o.blanking_m, "nothing is recorded nearer than this", atLeast(0))
      .add("gain_db", o.gain_db, "brings 1 uPa to full scale")
      .add("tvg_spreading_db", o.tvgSpreading_db, "time-varying gain per decade of range")
      .add("tvg_absorption_db_per_m", o.tvgAbsorption_dbPerM, "time-varying gain, two way")
      .add("gamma", o.gamma, "sample = amplitude^gamma", {0.1, 2})
      .add("sound_speed_mps", o.soundSpeed_mps, "the true one", {1300, 1700})
      .add("sound_speed_assumed_mps", o.soundSpeedAssumed_mps, "the one the device turns time into range by",
           {1300, 1700});
}

void addSonarArtefacts(OptionTable& t, SonarArtefacts& a) {
  t.add("row_leak", a.rowLeak, "a share of a row's power on all its beams")
      .add("row_leak_db", a.rowLeak_db, "of the row's mean")
      .add("ring_down", a.ringDown, "the transducer's ringing")
      .add("ring_down_db", a.ringDown_db, "at range 0, over the noise")
      .add("ring_down_decay_db_per_m", a.ringDownDecay_dbPerM, "its decay", positive())
      .add("banding", a.banding, "gain steps between groups of rows")
      .add("band_rows", a.bandRows, "rows in a group", {1, 100000})
      .add("band_sigma_db", a.bandSigma_db, "size of the steps", atLeast(0))
      .add("streaks", a.streaks, "noise over groups of beams in single rows")
      .add("streaks_per_ping", a.streaksPerPing, "mean number", atLeast(0))
      .add("streak_beams", a.streakBeams, "mean width", positive())
      .add("streak_db", a.streak_db, "over the noise")
      .add("centre_haze", a.centreHaze, "noise over the central beams")
      .add("centre_haze_db", a.centreHaze_db, "over the noise")
      .addDegrees("centre_width_deg", a.centreWidth_rad, "standard deviation of the haze's bell", positive())
      .add("cross_talk", a.crossTalk, "transmissions of the other sonar")
      .add("cross_talk_share", a.crossTalkShare, "of the pings in which one falls", {0, 1})
      .add("cross_talk_db", a.crossTalk_db, "over the noise");
}

}  // namespace

OptionTable optionTable(SonarOptions& o) {
  OptionTable t;
  addSonarDevice(t, o);
  addSonarPhysics(t, o);
  addSonarArtefacts(t, o.artefacts);
  return t;
}

OptionTable optionTable(GnssOptions& o) {
  OptionTable t;
  t.add("enabled", o.enabled, "simulate a receiver")
      .add("label", o.label, "sensor label")
      .add("rate_hz", o.rate_hz, "fixes a second", positive())
      .addPose("pose", o.T_vehicle_antenna, "antenna on the vehicle")
      .add("noise_m", o.noise_m, "white noise per axis", atLeast(0))
      .add("wander_m", o.wander_m, "standard deviation of the wandering error", atLeast(0))
      .add("wander_time_s", o.wanderTime_s, "its correlation time", positive())
      .add("origin_latitude", o.originLatitude_deg, "of the world's origin, degrees", {-89, 89})
      .add("origin_longitude", o.originLongitude_deg, "of the world's origin, degrees", {-180, 180})
      .add("origin_height_m", o.originHeight_m, "of the world's origin");
  return t;
}

OptionTable optionTable(MountingErrors& e) {
  OptionTable t;
  t.addPose("lidar_error", e.lidar, "true mounting = nominal * this")
      .addPose("sonar_horizontal_error", e.sonarHorizontal, "true mounting = nominal * this")
      .addPose("sonar_vertical_error", e.sonarVertical, "true mounting = nominal * this");
  return t;
}

OptionTable optionTable(SensorFaults& f) {
  OptionTable t;
  t.add("time_offset_s", f.timeOffset_s, "recorded minus true time")
      .add("jitter_s", f.jitter_s, "standard deviation of the recorded times", atLeast(0))
      .add("drop_share", f.dropShare, "share of records lost at random", {0, 1})
      .add("silent_from_s", f.silentFrom_s, "the sensor is silent from here", atLeast(0))
      .add("silent_for_s", f.silentFor_s, "for so long", atLeast(0));
  return t;
}

OptionTable optionTable(FaultOptions& f) {
  OptionTable t;
  t.add("clock_jump_at_s", f.clockJumpAt_s, "the recording clock jumps here", atLeast(0))
      .add("clock_jump_s", f.clockJump_s, "by this; 0: it does not")
      .add("cut_bytes", f.cutBytes, "bytes missing at the end of the rawlog", {0, 1e9})
      .add("spoof_from_s", f.spoofFrom_s, "the GNSS drifts away from here", atLeast(0))
      .add("spoof_drift_mps", f.spoofDrift_mps, "speed of the drift; 0: none", atLeast(0))
      .addDegrees("spoof_direction_deg", f.spoofDirection_rad, "direction of the drift in the world");
  return t;
}

namespace {

/// Calls `visit(section, options)` for each section of a simulation.
template <class Visit>
void forEachSection(SimulationOptions& o, const Visit& visit) {
  visit("vessel", o.vessel);
  visit("waves", o.waves);
  visit("lidar", o.lidar);
  visit("imu", o.imu);
  visit("sonar.horizontal", o.sonarHorizontal);
  visit("sonar.vertical", o.sonarVertical);
  visit("gnss", o.gnss);
  visit("mounting", o.mountingErrors);
  visit("faults", o.faults);
  visit("faults.lidar", o.faults.lidar);
  visit("faults.imu", o.faults.imu);
  visit("faults.sonar_horizontal", o.faults.sonarHorizontal);
  visit("faults.sonar_vertical", o.faults.sonarVertical);
  visit("faults.gnss", o.faults.gnss);
}

}  // namespace

void loadSimulationOptions(IniFile& ini, SimulationOptions& options) {
  forEachSection(options, [&](const char* section, auto& o) { optionTable(o).load(ini, section); });
}

std::string printSimulationOptions(SimulationOptions options) {
  std::string text;
  forEachSection(options, [&](const char* section, auto& o) { text += optionTable(o).print(section) + "\n"; });
  return text;
}

}  // namespace s2s::sim
