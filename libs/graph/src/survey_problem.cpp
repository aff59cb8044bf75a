#include "survey_problem.h"

#include <Eigen/Cholesky>

#include "s2s/graph/factors/gravity_factor.h"
#include "s2s/graph/factors/waterline_factor.h"

namespace s2s::graph {

namespace {

constexpr double kHeldSigma = 1e-4;         // metres and radians: stiff, yet far from numerically singular
constexpr double kFreeTiltSigma_rad = 0.2;  // of the first keyframe, when gravity tells its roll and pitch

void addAnchor(const SurveyState& state, bool gravityKnown, GraphProblem& graph) {
  core::Vector6 sigma = core::Vector6::Constant(kHeldSigma);
  if (gravityKnown) sigma.segment<2>(3).setConstant(kFreeTiltSigma_rad);
  graph.addPrior(0, state.keyframes.front().T_odom_vehicle, sigma.array().square().inverse().matrix().asDiagonal());
}

/// Number of measurements that share one error lasting `correlation_s`, judged by the time since the last one.
double countingAsOne(const std::optional<core::TimeNs>& last, core::TimeNs time, double correlation_s) {
  const double since_s = last ? std::max(core::secondsBetween(*last, time), 0.01) : correlation_s;
  return std::max(1.0, correlation_s / std::max(since_s, 0.01));
}

bool addGravity(const SurveyState& state, const GraphSlamOptions& options, GraphProblem& graph) {
  std::optional<core::TimeNs> last;
  for (std::size_t k = 0; k < state.gravity.size(); ++k) {
    if (!state.gravity[k]) continue;
    const core::TimeNs time = state.keyframes[k].time;
    const double together = countingAsOne(last, time, options.gravityCorrelation_s);
    const double sigma_rad = std::hypot(state.gravity[k]->sigma_rad, options.gravityFloor_rad) * std::sqrt(together);
    graph.add(new GravityFactor(state.gravity[k]->up_vehicle, sigma_rad), nullptr, {graph.pose(k)});
    last = time;
  }
  return last.has_value();
}

void addClosures(const SurveyState& state, double lossWidth, GraphProblem& graph) {
  for (const auto& closure : state.closures)
    if (closure.status == ClosureStatus::accepted)
      graph.addBetween(closure.from, closure.to, closure.T_from_to, closure.covariance.inverse(),
                       new ceres::CauchyLoss(lossWidth));
}

/// Returns true if the prior map holds the survey, which then needs no anchor of its own.
bool addPriorFixes(const SurveyState& state, double lossWidth, GraphProblem& graph) {
  bool any = false;
  for (const auto& fix : state.priorFixes) {
    if (fix.status != ClosureStatus::accepted) continue;
    graph.addPrior(static_cast<std::size_t>(fix.to), fix.T_from_to, fix.covariance.inverse(),
                   new ceres::CauchyLoss(lossWidth));
    any = true;
  }
  return any;
}

/// One height of the surface for each section of time, each tied softly to the one before.
void addWaterline(const SurveyState& state, const WaterlineOptions& options, SurveyProblem& survey) {
  GraphProblem& graph = *survey.graph;
  double* level = nullptr;
  core::TimeNs sectionEnd = 0;
  for (std::size_t k = 0; k < state.keyframes.size(); ++k) {
    const Keyframe& keyframe = state.keyframes[k];
    if (!level || keyframe.time >= sectionEnd) {
      double* const next = graph.addScalar(keyframe.T_map_vehicle.translation().z() - options.height_m);
      if (level)
        graph.add(new WaterlineDriftFactor(options.driftSigma_m), new ceres::CauchyLoss(options.lossWidth),
                  {level, next});
      level = next;
      sectionEnd = keyframe.time + core::durationNs(options.section_s);
    }
    graph.add(new WaterlineFactor(options.height_m, options.sigma_m), new ceres::CauchyLoss(options.lossWidth),
              {graph.pose(k), level});
    survey.waterLevels.push_back(level);
  }
}

void addGnss(const SurveyState& state, const GnssOptions& options, SurveyProblem& survey) {
  GraphProblem& graph = *survey.graph;
  const GnssAssessment assessment = assessGnss(state.fixes, state.keyframes, options);
  survey.gnss = assessment.report;
  if (assessment.report.state != GnssState::trusted || !assessment.report.T_enu_map) return;
  const core::Isometry& T = *assessment.report.T_enu_map;
  survey.alignment = graph.addAlignment(
      {T.translation().x(), T.translation().y(), T.translation().z(), std::atan2(T.linear()(1, 0), T.linear()(0, 0))});
  std::optional<core::TimeNs> last;
  for (std::size_t n = 0; n < state.fixes.size(); ++n) {
    if (!assessment.believable[n]) continue;
    const TiedFix& tied = state.fixes[n];
    const double together = countingAsOne(last, tied.fix.time, options.correlation_s);
    last = tied.fix.time;
    graph.add(new GnssFactor(tied.fix.p_enu, tied.p_keyframe_antenna,
                             tied.fix.sigma_m.cwiseMax(options.minSigma_m) * std::sqrt(together)),
              new ceres::CauchyLoss(options.lossWidth), {graph.pose(tied.keyframe), survey.alignment});
  }
}

}  // namespace

core::Matrix6 stepInformation(const OdometryChain& chain, int k) {
  return chain.stepCovariance(k).ldlt().solve(core::Matrix6::Identity());
}

SurveyProblem makeSurveyProblem(const SurveyState& state, const GraphSlamOptions& options) {
  std::vector<core::Isometry> poses;
  for (const auto& keyframe : state.keyframes) poses.push_back(keyframe.T_map_vehicle);
  SurveyProblem survey;
  survey.graph = std::make_unique<GraphProblem>(poses);
  GraphProblem& graph = *survey.graph;
  for (int k = 1; k < state.chain.size(); ++k)
    graph.addBetween(k - 1, k, state.chain.relative(k - 1, k), stepInformation(state.chain, k), nullptr);
  const bool gravityKnown = options.useGravity && addGravity(state, options, graph);
  if (!addPriorFixes(state, options.closureLossWidth, graph)) addAnchor(state, gravityKnown, graph);
  addClosures(state, options.closureLossWidth, graph);
  if (options.waterline.enabled && !state.offTheWater) addWaterline(state, options.waterline, survey);
  addGnss(state, options.gnss, survey);
  return survey;
}

}  // namespace s2s::graph
