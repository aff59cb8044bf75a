#include "calibration_gatherer.h"

#include <iterator>

#include "s2s/core/error.h"
#include "s2s/map/surface_evidence.h"
#include "s2s/mapper/stage_options.h"

namespace s2s::mapper {

namespace {

constexpr double kUsualSoundSpeed_mps = 1480;

/// Time offsets and sound speed are estimated, so pings must come as they were recorded.
MapperOptions asRecorded(MapperOptions options) {
  options.timeOffsetHorizontal_s = options.timeOffsetVertical_s = options.soundSpeed_mps = 0;
  return options;
}

}  // namespace

CalibrationGatherer::CalibrationGatherer(const SurveyConfig& config, int threads)
    : config_(config),
      mapperOptions_(asRecorded(config.mapper)),
      router_(mapperOptions_, faults_),
      backend_(graphOptions(config), config.map),
      odometry_(odometryStageOptions(config), faults_, [this](const OdometryUpdate& update) { onOdometry(update); }),
      odometryWorker_(threads > 1, static_cast<std::size_t>(config.mapper.queueCapacity)),
      horizontal_(config.sonar.horizontal),
      vertical_(config.sonar.vertical) {}

void CalibrationGatherer::push(const mrpt::obs::CObservation::Ptr& observation, const std::string& where) {
  const Role role = router_.route(*observation, where);
  if (role == Role::Imu) odometryWorker_.post([this, observation] { odometry_.addImu(*observation); });
  if (role == Role::Lidar) odometryWorker_.post([this, observation] { odometry_.addLidar(observation); });
  if (role == Role::SonarHorizontal || role == Role::SonarVertical)
    addPing(role, dynamic_cast<const obs::CObservationImagingSonar&>(*observation));
}

void CalibrationGatherer::finish(const std::string& rawlog) {
  router_.requireLidar(rawlog);
  odometryWorker_.finish();
  odometry_.finish();
  backend_.finish();
  for (const auto role : {Role::SonarHorizontal, Role::SonarVertical})
    if (router_.count(role) == 0)
      throw core::InputError(
          std::string("no pings of the ") + (role == Role::SonarHorizontal ? "horizontal" : "vertical") + " sonar",
          rawlog, "set label_sonar_horizontal and label_sonar_vertical in [mapper]");
}

calib::CalibrationEvidence CalibrationGatherer::evidence() {
  calib::CalibrationEvidence evidence;
  evidence.T_map_vehicle = trajectory();
  evidence.pings = std::move(pings_);
  evidence.texture = std::move(texture_);
  evidence.aperture = std::move(aperture_);
  evidence.mirror = std::move(mirror_);
  if (!config_.mapper.onWater || evidence.T_map_vehicle.empty()) return evidence;
  double water_m = 0;
  for (const auto& pose : evidence.T_map_vehicle.poses())
    water_m += (pose.T * Eigen::Vector3d(0, 0, config_.mapper.waterline_m)).z();
  evidence.waterHeight_m = water_m / static_cast<double>(evidence.T_map_vehicle.size());
  evidence.wallAt = walls(*evidence.waterHeight_m);
  return evidence;
}

core::Trajectory CalibrationGatherer::trajectory() const {
  core::Trajectory poses;
  for (const auto& pose : path_.poses()) poses.append(pose.time, backend_.map().poseAt(pose.time, pose.T));
  return poses;
}

/// Walls among what the LiDAR saw above the water.
calib::WallFinder CalibrationGatherer::walls(double waterHeight_m) const {
  const auto walls = std::make_shared<map::SurfaceEvidence>();
  walls->reset(config_.map.resolver);
  backend_.map().forEachPoint(map::Layer::Lidar, [&](const map::MapPoint& point) {
    const double above_m = point.p_map.z() - waterHeight_m;
    if (above_m >= 0 && above_m <= config_.map.resolver.lidarWallBand_m) walls->addWallPoint(point.p_map);
  });
  return [walls](double x_m, double y_m) -> std::optional<calib::WallPlane> {
    const auto wall = walls->wallNear(x_m, y_m);
    if (!wall) return {};
    return calib::WallPlane{wall->normal, wall->offset_m};
  };
}

void CalibrationGatherer::onOdometry(const OdometryUpdate& update) {
  for (const auto& pose : update.path) path_.append(pose.time, pose.T);
  if (update.keyframe) backend_.addKeyframe(*update.keyframe);
}

void CalibrationGatherer::addPing(Role role, const obs::CObservationImagingSonar& ping) {
  const auto id = role == Role::SonarHorizontal ? calib::SonarId::Horizontal : calib::SonarId::Vertical;
  try {
    ping.checkConsistent();
  } catch (const core::InputError& e) {
    faults_.add("unusable pings were dropped: " + e.fault());
    return;
  }
  if (!described_[id]) describe(id, ping);
  calib::PingEchoes echoes;
  echoes.time = core::fromMrptTime(ping.timestamp);
  echoes.sonar = id;
  if (id == calib::SonarId::Horizontal)
    addHorizontal(ping, echoes);
  else
    addVertical(ping, echoes);
  pings_.push_back(std::move(echoes));
}

void CalibrationGatherer::addHorizontal(const obs::CObservationImagingSonar& ping, calib::PingEchoes& echoes) {
  const auto& sonar = nominal_[calib::SonarId::Horizontal];
  echoes.echoes = calib::returnsOf(horizontal_.process(ping).lineScan, sonar.T_vehicle_sonar, config_.swath.beamStep);
  if (config_.calibration.texture.enabled)
    texture_.push_back(calib::texturePing(ping, echoes.time, config_.calibration.texture));
  if (config_.calibration.aperture.enabled && horizontalPings_++ % config_.calibration.aperture.pingStep == 0)
    aperture_.push_back(calib::aperturePing(ping, echoes.time, config_.calibration.aperture));
  if (config_.calibration.farEdgeBearing_rad > 0)
    for (const auto& echo : calib::echoesOf(calib::findSwaths(ping, config_.swath), sonar.T_vehicle_sonar,
                                            sonar.aperture_rad, ping.maxRange_m()))
      if (echo.kind == calib::EchoKind::FarEdge) echoes.echoes.push_back(echo);
}

void CalibrationGatherer::addVertical(const obs::CObservationImagingSonar& ping, calib::PingEchoes& echoes) {
  const auto& sonar = nominal_[calib::SonarId::Vertical];
  echoes.echoes = calib::echoesOf(calib::findSwaths(ping, config_.swath), sonar.T_vehicle_sonar, sonar.aperture_rad,
                                  ping.maxRange_m());
  auto traces =
      calib::mirrorTraces(ping, vertical_.process(ping).lineScan, sonar.T_vehicle_sonar, config_.calibration.mirror);
  std::move(traces.begin(), traces.end(), std::back_inserter(mirror_));
}

void CalibrationGatherer::describe(calib::SonarId id, const obs::CObservationImagingSonar& ping) {
  const bool isHorizontal = id == calib::SonarId::Horizontal;
  described_[id] = true;
  auto& sonar = nominal_[id];
  sonar.T_vehicle_sonar = core::toIsometry(ping.sensorPose);
  sonar.timeOffset_s = isHorizontal ? config_.mapper.timeOffsetHorizontal_s : config_.mapper.timeOffsetVertical_s;
  sonar.aperture_rad = ping.verticalAperture_rad;
  sonar.model = ping.bearingModel;
  sonar.deviceSoundSpeed_mps = ping.soundSpeed_mps > 0 ? ping.soundSpeed_mps : kUsualSoundSpeed_mps;
  if (ping.soundSpeed_mps <= 0)
    faults_.add("pings of '" + ping.sensorLabel + "' do not tell their sound speed; 1480 m/s was taken");
  nominal_.nominalSoundSpeed_mps =
      config_.mapper.soundSpeed_mps > 0 ? config_.mapper.soundSpeed_mps : sonar.deviceSoundSpeed_mps;
  nominal_.soundSpeed_mps = nominal_.nominalSoundSpeed_mps;
}

}  // namespace s2s::mapper
