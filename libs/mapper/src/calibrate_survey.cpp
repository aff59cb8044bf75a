#include "s2s/mapper/calibrate_survey.h"

#include "s2s/core/error.h"
#include "s2s/core/progress.h"
#include "s2s/mapper/backend_stage.h"
#include "s2s/mapper/odometry_stage.h"
#include "s2s/mapper/sensor_router.h"
#include "s2s/mapper/stage_options.h"
#include "s2s/mapper/worker.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "survey_reading.h"

namespace s2s::mapper {

namespace {

/// LiDAR and IMU go through odometry and graph, pings become echoes.
class Gatherer {
 public:
  Gatherer(const SurveyConfig& config, int threads)
      : config_(config),
        mapperOptions_(asRecorded(config.mapper)),
        router_(mapperOptions_, faults_),
        backend_(graphOptions(config), config.map),
        odometry_(odometryStageOptions(config), faults_, [this](const OdometryUpdate& update) { onOdometry(update); }),
        odometryWorker_(threads > 1, static_cast<std::size_t>(config.mapper.queueCapacity)) {}

  void push(const mrpt::obs::CObservation::Ptr& observation, const std::string& where) {
    const Role role = router_.route(*observation, where);
    if (role == Role::Imu) odometryWorker_.post([this, observation] { odometry_.addImu(*observation); });
    if (role == Role::Lidar) odometryWorker_.post([this, observation] { odometry_.addLidar(observation); });
    if (role == Role::SonarHorizontal || role == Role::SonarVertical)
      addPing(role, dynamic_cast<const obs::CObservationImagingSonar&>(*observation));
  }

  void finish(const std::string& rawlog) {
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

  const calib::CalibrationState& nominal() const { return nominal_; }
  const std::vector<calib::PingEchoes>& pings() const { return pings_; }
  FaultLog& faults() { return faults_; }

  core::Trajectory trajectory() const {
    core::Trajectory poses;
    for (const auto& pose : path_.poses()) poses.append(pose.time, backend_.map().poseAt(pose.time, pose.T));
    return poses;
  }

 private:
  /// Time offsets and sound speed are estimated, so pings must come as they were recorded.
  static MapperOptions asRecorded(MapperOptions options) {
    options.timeOffsetHorizontal_s = options.timeOffsetVertical_s = options.soundSpeed_mps = 0;
    return options;
  }

  void onOdometry(const OdometryUpdate& update) {
    for (const auto& pose : update.path) path_.append(pose.time, pose.T);
    if (update.keyframe) backend_.addKeyframe(*update.keyframe);
  }

  void addPing(Role role, const obs::CObservationImagingSonar& ping) {
    const auto id = role == Role::SonarHorizontal ? calib::SonarId::Horizontal : calib::SonarId::Vertical;
    try {
      ping.checkConsistent();
    } catch (const core::InputError& e) {
      faults_.add("unusable pings were dropped: " + e.fault());
      return;
    }
    if (!described_[id]) describe(id, ping);
    const auto& sonar = nominal_[id];
    calib::PingEchoes echoes;
    echoes.time = core::fromMrptTime(ping.timestamp);
    echoes.sonar = id;
    echoes.echoes = calib::echoesOf(calib::findSwaths(ping, config_.swath), sonar.T_vehicle_sonar, sonar.aperture_rad,
                                    ping.maxRange_m());
    pings_.push_back(std::move(echoes));
  }

  /// Takes what is nominal of a sonar from its first usable ping and the configuration.
  void describe(calib::SonarId id, const obs::CObservationImagingSonar& ping) {
    constexpr double kUsualSoundSpeed_mps = 1480;
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

  const SurveyConfig& config_;
  const MapperOptions mapperOptions_;
  FaultLog faults_;
  SensorRouter router_;
  BackendStage backend_;
  core::Trajectory path_;  // T_odom_vehicle
  OdometryStage odometry_;
  Worker odometryWorker_;
  calib::CalibrationState nominal_;
  std::map<calib::SonarId, bool> described_;
  std::vector<calib::PingEchoes> pings_;
};

}  // namespace

SurveyCalibration calibrateSurvey(const CalibrationRun& run, const SurveyConfig& config) {
  obs::RawlogReader reader(run.rawlog);
  Gatherer gatherer(config, run.threads);
  readRecords({run.from_s, run.to_s, "Reading survey", run.progress}, reader, gatherer.faults(),
              [&gatherer](const auto& record, const std::string& where) { gatherer.push(record, where); });
  gatherer.finish(run.rawlog);
  SurveyCalibration calibration;
  calibration.pings = gatherer.pings().size();
  calibration.warnings = gatherer.faults().lines();
  core::Progress progress(run.progress, "Calibrating", 0, "rounds");
  auto options = config.calibration;
  options.threads = run.threads;
  calibration.result = calib::calibrate(gatherer.nominal(), gatherer.pings(), gatherer.trajectory(), options,
                                        [&progress](int done, int total) {
                                          progress.setTotal(total);
                                          progress.update(done);
                                        });
  return calibration;
}

}  // namespace s2s::mapper
