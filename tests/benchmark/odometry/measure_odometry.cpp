#include <mrpt/obs/CObservationIMU.h>

#include <cstdio>
#include <filesystem>

#include "command_line.h"
#include "contestant.h"
#include "mrpt_icp_odometry.h"
#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/core/ini_file.h"
#include "s2s/eval/trajectory_error.h"
#include "s2s/mapper/sensor_router.h"
#include "s2s/mapper/stage_options.h"
#include "s2s/mapper/survey_config.h"
#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/obs/rawlog_reader.h"
#include "s2s/products/trajectory_files.h"

namespace {

using namespace s2s;
using Contestants = std::vector<std::unique_ptr<bench::Contestant>>;

/// Sweeps a second at which the mapping of the paper keeps up.
constexpr double kPaperRate_hz = 2.85;

struct Request {
  std::string folder, config, csv;
  std::vector<std::string> overrides;
  double from_s = 0, to_s = -1;
  bool all = false;
};

Contestants contestantsFor(const odometry::OdometryOptions& options, bool all) {
  Contestants contestants;
  contestants.push_back(std::make_unique<bench::OurOdometry>("as configured", options));
  if (!all) return contestants;
  auto withoutImu = options;
  withoutImu.imuUse = odometry::ImuUse::never;
  contestants.push_back(std::make_unique<bench::OurOdometry>("IMU off", withoutImu));
  contestants.push_back(std::make_unique<bench::OurOdometry>("keyframe rate only", options, 0.99 / kPaperRate_hz));
  contestants.push_back(std::make_unique<bench::MrptIcpOdometry>("MRPT's ICP", options));
  return contestants;
}

/// Stereo points of the sonars, made as the mapper makes them, for all contestants; `motion` is that of the first.
class StereoSource {
 public:
  StereoSource(const mapper::SurveyConfig& config, const bench::OurOdometry& motion)
      : images_(config.sonar.horizontal, config.sonar.vertical, config.sonar.stereo),
        pairer_(config.sonar, config.mapper.stereoPairWindow_s,
                [&motion](core::TimeNs from, core::TimeNs to) { return motion.expectedMotion(from, to); }) {}

  std::vector<mapper::StereoScan> add(mapper::Role role, const obs::CObservationImagingSonar& ping) {
    std::promise<std::shared_ptr<const sonar::ProcessedPing>> image;
    const auto& device = role == mapper::Role::SonarHorizontal ? images_.horizontal() : images_.vertical();
    image.set_value(std::make_shared<const sonar::ProcessedPing>(device.process(ping)));
    return pairer_.add(
        {role, core::fromMrptTime(ping.timestamp), core::toIsometry(ping.sensorPose), image.get_future().share()});
  }

 private:
  sonar::SonarStereo images_;
  mapper::StereoPairer pairer_;
};

/// One pass over the rawlog for all.
void feed(const Request& request, const mapper::SurveyConfig& config, Contestants& contestants) {
  obs::RawlogReader reader(request.folder + "/survey.rawlog");
  mapper::FaultLog faults;
  mapper::SensorRouter router(config.mapper, faults);
  StereoSource stereo(config, dynamic_cast<const bench::OurOdometry&>(*contestants.front()));
  std::optional<core::TimeNs> start;
  while (const auto observation = reader.next()) {
    const core::TimeNs time = core::fromMrptTime(observation->timestamp);
    if (!start) start = time;
    const double elapsed_s = core::secondsBetween(*start, time);
    if (elapsed_s < request.from_s) continue;
    if (request.to_s >= 0 && elapsed_s > request.to_s) break;
    const auto role = router.route(*observation, "");
    if (role == mapper::Role::Imu) {
      const auto sample = odometry::imuSampleFrom(dynamic_cast<mrpt::obs::CObservationIMU&>(*observation));
      for (auto& contestant : contestants)
        if (sample) contestant->imu(*sample);
    }
    if (role == mapper::Role::Lidar)
      for (auto& contestant : contestants) contestant->sweep(dynamic_cast<obs::CObservationLidarSweep&>(*observation));
    if (const auto* ping = dynamic_cast<const obs::CObservationImagingSonar*>(observation.get());
        ping && role != mapper::Role::None)
      for (const auto& scan : stereo.add(role, *ping))
        for (auto& contestant : contestants) contestant->acoustic(mapper::acousticScan(scan));
  }
  for (auto& contestant : contestants) contestant->finish();
}

/// Whether the odometry knows how wrong it is: errors of its motions over some way by their stated covariance.
void printConsistency(const bench::Contestant& contestant, const core::Trajectory& truth, double way_m) {
  odometry::MotionAccumulator motion;
  std::optional<core::Isometry> T_world_start;
  core::Vector6 ratio2 = core::Vector6::Zero();
  double nees = 0;
  double sailed_m = 0;
  int count = 0;
  const core::Isometry* T_odom_last = nullptr;
  for (const auto& result : contestant.results()) {
    if (!result.covariance_registration.ldlt().isPositive() || result.covariance_registration.isZero()) return;
    const auto T_world_now = truth.at(result.time);
    if (!T_world_now) continue;
    motion.add(result);
    if (!T_world_start) {
      motion.restart();
      T_world_start = T_world_now;
    }
    if (T_odom_last) sailed_m += (T_odom_last->inverse() * result.T_odom_vehicle).translation().norm();
    T_odom_last = &result.T_odom_vehicle;
    if (sailed_m < way_m) continue;
    sailed_m = 0;
    const auto estimate = motion.motion();
    const core::Isometry error = (T_world_start->inverse() * *T_world_now).inverse() * estimate.T_from_to;
    core::Vector6 e;
    e << error.translation(), core::logSo3(error.linear());
    ratio2 += e.cwiseAbs2().cwiseQuotient(estimate.covariance.diagonal());
    nees += e.dot(estimate.covariance.ldlt().solve(e));
    ++count;
    motion.restart();
    T_world_start = T_world_now;
  }
  if (count == 0) return;
  const core::Vector6 ratio = (ratio2 / count).cwiseSqrt();
  std::printf(
      "    %d motions of %.0f m, error over its stated deviation (1 is ideal): ahead %.2f left %.2f up %.2f "
      "roll %.2f pitch %.2f yaw %.2f; NEES %.1f (6)\n",
      count, way_m, ratio[0], ratio[1], ratio[2], ratio[3], ratio[4], ratio[5], nees / count);
}

void printRow(const bench::Contestant& contestant, const core::Trajectory& truth) {
  core::Trajectory poses;
  for (const auto& result : contestant.results()) poses.append(result.time, result.T_odom_vehicle);
  const auto pairs = eval::pairByTime(truth, poses);
  if (pairs.empty()) throw core::InputError("no pose has a true one beside it", "", "give a survey with its truth");
  const auto segments = eval::segmentError(pairs, 100.0);
  const auto absolute = eval::absoluteError(pairs, eval::TrajectoryAlignment::Positions);
  const auto cpu = eval::summarise(contestant.seconds());
  std::printf(
      "%-20s %7zu poses  100 m: %.3f %%  %.4f deg/10 m  ATE %.3f m (max %.3f)  CPU/sweep %5.1f ms (95 %% %.1f)\n",
      contestant.name().c_str(), poses.size(), 100 * segments.translation_share,
      segments.rotation_radpm * 10 * 180 / M_PI, absolute.translation_m.rmse, absolute.translation_m.max,
      1e3 * cpu.median, 1e3 * cpu.p95);
  for (const double way_m : {10.0, 100.0}) printConsistency(contestant, truth, way_m);
}

/// Every pose's error against the truth when both start at the first pose, and its stated standard deviations.
void writeErrors(const std::string& path, const bench::Contestant& contestant, const core::Trajectory& truth) {
  std::string text =
      "time,status,ex,ey,ez,erx,ery,erz,sx,sy,sz,srx,sry,srz,true_x,true_y,true_z,height_error,tilt_x,tilt_y,"
      "gravity_sigma,matches\n";
  const auto& results = contestant.results();
  const auto first = truth.at(results.front().time);
  for (const auto& result : results) {
    const auto now = truth.at(result.time);
    if (!first || !now) continue;
    const core::Isometry error =
        (first->inverse() * *now).inverse() * results.front().T_odom_vehicle.inverse() * result.T_odom_vehicle;
    const Eigen::Vector3d up = result.T_odom_vehicle.linear() * now->linear().transpose() * Eigen::Vector3d::UnitZ();
    const double height =
        result.T_odom_vehicle.translation().dot(up) - (now->translation().z() - first->translation().z());
    text += core::printDouble(core::secondsBetween(results.front().time, result.time)) + "," +
            std::to_string(static_cast<int>(result.status));
    core::Vector6 e;
    e << error.translation(), core::logSo3(error.linear());
    for (int i = 0; i < 6; ++i) text += "," + core::printDouble(e[i]);
    for (int i = 0; i < 6; ++i) text += "," + core::printDouble(std::sqrt(result.covariance_pose(i, i)));
    for (int i = 0; i < 3; ++i) text += "," + core::printDouble(now->translation()[i]);
    for (const double value : {height, up.x() - result.up_odom.x(), up.y() - result.up_odom.y(),
                               result.gravitySigma_rad, static_cast<double>(result.matchCount)})
      text += "," + core::printDouble(value);
    text += "\n";
  }
  core::writeTextFile(path, text);
}

int measure(const Request& request) {
  const std::string config = request.config.empty() ? request.folder + "/survey.ini" : request.config;
  const auto survey = mapper::loadSurveyConfig(config, request.overrides);
  auto contestants = contestantsFor(mapper::odometryStageOptions(survey).odometry, request.all);
  feed(request, survey, contestants);
  const auto truth = products::readTum(request.folder + "/truth/trajectory.tum");
  for (const auto& contestant : contestants) printRow(*contestant, truth);
  for (const auto& found : odometry::contradictions(contestants.front()->results().back().imu))
    std::printf("warning: %s\n", found.c_str());
  if (!request.csv.empty()) writeErrors(request.csv, *contestants.front(), truth);
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures the odometry alone against the truth of a simulated survey", "measure_odometry");
  Request request;
  app.add_option("survey", request.folder, "Output folder of simulate-survey")->required();
  app.add_option("--config", request.config, "INI of the survey; default: its own survey.ini");
  app.add_option("--set", request.overrides, "section.key=value")->allow_extra_args(false);
  app.add_option("--from", request.from_s, "Start this many seconds into the survey");
  app.add_option("--to", request.to_s, "End there");
  app.add_option("--csv", request.csv, "Every pose's error and stated deviation");
  app.add_flag("--all", request.all, "Other ways of doing it beside it");
  return apps::run(app, argc, argv, [&] { return measure(request); });
}
