#include "s2s/mapper/run_survey.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <thread>

#include "gnss_summary.h"
#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/core/progress.h"
#include "s2s/graph/graph_io.h"
#include "s2s/mapper/prior_map_loader.h"
#include "s2s/mapper/survey_mapper.h"
#include "s2s/obs/rawlog_reader.h"
#include "s2s/products/write_products.h"
#include "survey_reading.h"

namespace s2s::mapper {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Hands out records at their recorded rate.
class Pacemaker {
 public:
  explicit Pacemaker(LatencyMonitor& latencies) : latencies_(latencies) {}

  /// Sleeps until a record is due; how far reading itself is behind counts as a latency. A record without a time, or
  /// with one so far ahead that it will not be used, is due at once.
  void wait(core::TimeNs time) {
    constexpr double kLongestPause_s = 3600;
    if (time <= 0) return;
    if (!first_) first_ = last_ = time;
    if (core::secondsBetween(last_, time) > kLongestPause_s) return;
    last_ = std::max(last_, time);
    const std::chrono::duration<double> after(core::secondsBetween(*first_, time));
    const auto due = start_ + std::chrono::duration_cast<Clock::duration>(after);
    const auto now = Clock::now();
    latencies_.add("reading behind the recorded rate", std::max(now - due, Clock::duration::zero()));
    if (now < due) std::this_thread::sleep_until(due);
  }

 private:
  LatencyMonitor& latencies_;
  const Clock::time_point start_ = Clock::now();
  std::optional<core::TimeNs> first_;
  core::TimeNs last_ = 0;
};

/// Pushes the records of the chosen part of the rawlog into the mapper, in real time if wanted.
void readSurvey(const SurveyRun& run, obs::RawlogReader& reader, SurveyMapper& mapper) {
  Pacemaker pacemaker(mapper.latencies());
  readRecords({run.from_s, run.to_s, "Mapping", run.progress}, reader, mapper.faults(),
              [&](const mrpt::obs::CObservation::Ptr& record, const std::string& where) {
                if (run.realtime) pacemaker.wait(core::fromMrptTime(record->timestamp));
                mapper.push(record, where);
              });
}

/// Loop closures by what became of them; injected ones only if there were any.
void addClosureFigures(const std::vector<graph::LoopClosure>& closures, products::RunSummary& summary) {
  double candidates = 0, verified = 0, injected = 0, injectedAccepted = 0;
  for (const auto& closure : closures) {
    if (closure.source == graph::ClosureSource::sonar) continue;
    ++candidates;
    const bool accepted = closure.status == graph::ClosureStatus::accepted;
    if (closure.source == graph::ClosureSource::injected) {
      ++injected;
      if (accepted) ++injectedAccepted;
    } else if (accepted || closure.status == graph::ClosureStatus::pending ||
               closure.status == graph::ClosureStatus::rejectedByOdometry ||
               closure.status == graph::ClosureStatus::rejectedByOthers ||
               closure.status == graph::ClosureStatus::rejectedByOptimiser) {
      ++verified;
    }
  }
  summary.figures.emplace_back("loop_closure_candidates", candidates - injected);
  summary.figures.emplace_back("loop_closures_verified", verified);
  if (injected == 0) return;
  summary.figures.emplace_back("false_closures_injected", injected);
  summary.figures.emplace_back("false_closures_accepted", injectedAccepted);
}

void addSonarFigures(const graph::GraphStatistics& statistics, products::RunSummary& summary) {
  if (statistics.submaps == 0) return;
  summary.figures.emplace_back("acoustic_submaps", statistics.submaps);
  summary.figures.emplace_back("sonar_factor_candidates", statistics.sonarCandidates);
  summary.figures.emplace_back("sonar_factors", statistics.sonarAccepted);
}

/// Where the horizontal sonar's aperture was found to end, by the side that met the bed more often.
void addApertureFigures(const map::CSeabedSkyMap& map, products::RunSummary& summary) {
  const auto& [low, high] = map.apertureEnds();
  const map::ApertureEnd& end = low.pings() >= high.pings() ? low : high;
  if (end.pings() == 0) return;
  constexpr double kDegree = M_PI / 180;
  summary.figures.emplace_back("sonar_aperture_beyond_nominal_deg", end.beyond_rad() / kDegree);
  summary.figures.emplace_back("sonar_aperture_beyond_nominal_sigma_deg", end.sigma_rad() / kDegree);
}

void addRelocation(const SurveyRun& run, const graph::RelocationReport& report, products::RunSummary& summary) {
  if (!report.wanted) return;
  products::PriorMapSummary& prior = summary.priorMap.emplace();
  prior.folder = run.priorMap;
  prior.located = report.located;
  prior.registered = static_cast<std::uint64_t>(report.registered);
  prior.believed = static_cast<std::uint64_t>(report.believed);
  if (report.located)
    prior.after_s = core::secondsBetween(summary.startTime, report.locatedTime);
  else
    summary.warnings.push_back("the survey's place in the map " + run.priorMap +
                               " was not found: the new map stands in a frame of its own");
}

products::RunSummary summarize(const SurveyRun& run, const SurveyConfig& config, const SurveyMapper& mapper) {
  products::RunSummary summary;
  const auto& sensors = mapper.sensors();
  const auto trajectory = mapper.trajectory();
  summary.inputs = {run.rawlog};
  summary.startTime = sensors.first();
  summary.endTime = sensors.last();
  summary.duration_s = core::secondsBetween(sensors.first(), sensors.last());
  summary.sweeps = mapper.sweepCount();
  summary.pingsHorizontal = sensors.count(Role::SonarHorizontal);
  summary.pingsVertical = sensors.count(Role::SonarVertical);
  summary.imuSamples = sensors.count(Role::Imu);
  summary.keyframes = mapper.graph().keyframes().size();
  summary.loopClosures = static_cast<std::uint64_t>(mapper.graph().statistics().accepted);
  summary.pathLength_m = trajectory.length_m();
  if (config.mapper.onWater) {
    summary.waterHeight_m = mapper.waterHeight_m();
    summary.waterHeightSource = "mean height of the hull's waterline along the path";
  }
  summary.warnings = mapper.faults().lines();
  summary.gnss = gnssSummary(mapper.graph().gnssReport(), mapper.gnssOrigin());
  if (summary.gnss && summary.gnss->distrusted) summary.warnings.push_back(gnssWarning(*summary.gnss));
  std::map<std::string, mrpt::system::CTimeLogger::TCallStats> stages;
  mapper.profile().getStats(stages);
  for (const auto& [name, stats] : stages) summary.stageTimes_s.emplace_back(name, stats.total_t);
  addRelocation(run, mapper.graph().relocationReport(), summary);
  for (const auto& l : mapper.latencies().statistics())
    summary.latencies.push_back({l.name, l.count, l.median_s, l.p95_s, l.max_s});
  addClosureFigures(mapper.graph().loopClosures(), summary);
  addSonarFigures(mapper.graph().statistics(), summary);
  addApertureFigures(mapper.map(), summary);
  summary.effectiveIni = printSurveyConfig(config);
  return summary;
}

std::string inFolder(const SurveyRun& run, const std::string& name) {
  return (std::filesystem::path(run.output) / name).string();
}

}  // namespace

products::RunSummary runSurvey(const SurveyRun& run, const SurveyConfig& config) {
  const auto start = Clock::now();
  obs::RawlogReader reader(run.rawlog);
  core::writeTextFile(inFolder(run, "effective.ini"), printSurveyConfig(config));

  SurveyMapper mapper(config, run.threads, run.realtime,
                      run.priorMap.empty() ? nullptr : loadPriorMap(run.priorMap, config.graph));
  readSurvey(run, reader, mapper);
  mapper.sensors().requireLidar(run.rawlog);
  mapper.finish();
  if (mapper.graph().keyframes().empty())
    throw core::InputError("no sweep gave a pose, so there is no map", run.rawlog,
                           "look at the LiDAR in RawLogViewer; check the range limits in [odometry]");

  auto summary = summarize(run, config, mapper);
  summary.wall_s = secondsSince(start);
  const auto poses = mapper.graph().poseGraph();
  graph::writeGraph(inFolder(run, "graph.g2o"), poses);
  graph::writeGraph(inFolder(run, "graph.graph"), poses);
  core::Progress progress(run.progress, "Writing products", 0, "files");
  double files = 0;
  const auto result = products::writeProducts(
      mapper.map(), {mapper.trajectory(), mapper.odometryTrajectory(), mapper.keyframeTrajectory()}, summary,
      config.products, run.output, [&](const std::string&) { progress.update(++files); });
  return result.summary;
}

}  // namespace s2s::mapper
