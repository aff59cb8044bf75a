#include "s2s/mapper/survey_mapper.h"

#include "s2s/mapper/stage_options.h"
#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::mapper {

SurveyMapper::SurveyMapper(const SurveyConfig& config, int threads, bool realtime,
                           std::unique_ptr<graph::PriorMap> prior)
    : config_(config),
      latencies_(realtime),
      router_(config_.mapper, faults_),
      backend_(graphOptions(config_), config_.map, std::move(prior)),
      backendWorker_(threads > 1, static_cast<std::size_t>(config_.mapper.queueCapacity)),
      sonar_(config_.sonar, faults_, [this](const SonarScan& scan) { onSonarScan(scan); }),
      sonarWorker_(threads > 1, static_cast<std::size_t>(config_.mapper.queueCapacity)),
      odometry_(odometryStageOptions(config_), faults_,
                [this](OdometryUpdate update) { onOdometry(std::move(update)); }),
      odometryWorker_(threads > 1, static_cast<std::size_t>(config_.mapper.queueCapacity)) {}

SurveyMapper::~SurveyMapper() = default;

void SurveyMapper::push(const mrpt::obs::CObservation::Ptr& observation, const std::string& where) {
  const Role role = router_.route(*observation, where);
  latencies_.arrived(role, core::fromMrptTime(observation->timestamp));
  switch (role) {
    case Role::Imu:
      return odometryWorker_.post(timed("odometry: IMU", [this, observation] { odometry_.addImu(*observation); }));
    case Role::Lidar:
      postRecord(odometryWorker_, timed("odometry: sweep", [this, observation] { odometry_.addLidar(observation); }),
                 *observation);
      return;
    case Role::Gnss:
      return odometryWorker_.post([this, observation] { odometry_.addGnss(*observation); });
    case Role::SonarHorizontal:
    case Role::SonarVertical: {
      const auto ping = std::dynamic_pointer_cast<const obs::CObservationImagingSonar>(observation);
      const auto image = std::make_shared<std::promise<std::shared_ptr<const sonar::ProcessedPing>>>();
      const PendingPing pending{role, core::fromMrptTime(ping->timestamp), core::toIsometry(ping->sensorPose),
                                image->get_future().share()};
      auto process = timed("sonar: images", [this, role, ping, image] { sonar_.addPing({role, ping}, *image); });
      // The odometry waits for the image, so it must not hear of a ping that was dropped.
      if (!postRecord(sonarWorker_, std::move(process), *observation)) return;
      return odometryWorker_.post(timed("odometry: stereo", [this, pending] { odometry_.addPing(pending); }));
    }
    case Role::None:
      return;
  }
}

bool SurveyMapper::postRecord(Worker& worker, Worker::Task task, const mrpt::obs::CObservation& observation) {
  if (!latencies_.enabled()) {
    worker.post(std::move(task));
    return true;
  }
  if (worker.tryPost(std::move(task))) return true;
  faults_.add("records of '" + observation.sensorLabel + "' were dropped because processing was behind real time",
              core::formatUtc(core::fromMrptTime(observation.timestamp)));
  return false;
}

void SurveyMapper::onSonarScan(const SonarScan& scan) {
  backendWorker_.post(timed("back end: sonar scan", [this, scan] {
    backend_.addSonarScan(scan);
    const bool vertical = scan.layer == map::Layer::LineVertical;
    latencies_.done(scan.layer == map::Layer::Stereo ? "record: ping to stereo points in the map"
                                                     : "record: ping to line-scan in the map",
                    vertical ? Role::SonarVertical : Role::SonarHorizontal, scan.time);
  }));
}

void SurveyMapper::onOdometry(OdometryUpdate update) {
  latencies_.done("record: sweep to pose", Role::Lidar, update.sweepTime);
  if (const auto keyframe = std::exchange(update.keyframe, nullptr))
    backendWorker_.post(timed("back end: keyframe", [this, keyframe, sweepTime = update.sweepTime] {
      backend_.addKeyframe(*keyframe);
      latencies_.done("record: sweep to keyframe in the map", Role::Lidar, sweepTime);
    }));
  if (!update.fixes.empty())
    backendWorker_.post([this, fixes = std::move(update.fixes)] {
      for (const auto& fix : fixes) backend_.addGnss(fix);
    });
  sonarWorker_.post(timed("sonar: placing", [this, update = std::move(update)] { sonar_.addPoses(update); }));
}

void SurveyMapper::finish() {
  odometryWorker_.finish();
  odometry_.finish();
  sonarWorker_.finish();
  sonar_.finish();
  backendWorker_.finish();
  if (router_.count(Role::Imu) == 0 && config_.odometry.imuUse != odometry::ImuUse::never)
    faults_.add(
        "no record of an IMU labelled '" + config_.mapper.imu.label +
        "': the LiDAR alone was used, which knows the height and the vertical less well; check label_imu, or set "
        "imu = never in [odometry]");
  const mrpt::system::CTimeLoggerEntry timer(profile_, "back end: last optimisation");
  backend_.finish();
}

core::Trajectory SurveyMapper::trajectory() const {
  core::Trajectory poses;
  for (const auto& pose : odometry_.sweepPoses().poses()) poses.append(pose.time, map().poseAt(pose.time, pose.T));
  return poses;
}

core::Trajectory SurveyMapper::keyframeTrajectory() const {
  core::Trajectory poses;
  for (const auto& keyframe : graph().keyframes()) poses.append(keyframe.time, keyframe.T_map_vehicle);
  return poses;
}

double SurveyMapper::waterHeight_m() const {
  if (!config_.mapper.onWater) return 0;
  const Eigen::Vector3d waterline_vehicle(0, 0, config_.mapper.waterline_m);
  double sum_m = 0;
  const auto poses = trajectory();
  for (const auto& pose : poses.poses()) sum_m += (pose.T * waterline_vehicle).z();
  return poses.empty() ? 0 : sum_m / static_cast<double>(poses.size());
}

}  // namespace s2s::mapper
