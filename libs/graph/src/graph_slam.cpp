#include "s2s/graph/graph_slam.h"

#include <Eigen/Cholesky>
#include <chrono>

#include "closure_verifier.h"
#include "false_closure_source.h"
#include "marginals.h"
#include "relocaliser.h"
#include "s2s/core/error.h"
#include "s2s/graph/factors/gnss_factor.h"
#include "s2s/graph/mrpt_network.h"
#include "sonar_search.h"
#include "survey_problem.h"

namespace s2s::graph {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// The odometry's covariance if it is one, plus the drift floor for the metres travelled.
core::Matrix6 flooredCovariance(const core::Matrix6& given, double travelled_m, const ConsistencyOptions& options) {
  // A millimetre-sized minimum keeps steps without motion from becoming infinitely stiff.
  const double metres = std::max(travelled_m, 0.05);
  core::Vector6 floor;
  floor << Eigen::Vector3d::Constant(options.driftTranslation_m * options.driftTranslation_m * metres),
      Eigen::Vector3d::Constant(options.driftRotation_rad * options.driftRotation_rad * metres);
  core::Matrix6 covariance = floor.asDiagonal();
  const core::Matrix6 symmetric = 0.5 * (given + given.transpose());
  if (given.allFinite() && Eigen::LDLT<core::Matrix6>(symmetric).isPositive()) covariance += symmetric;
  return covariance;
}

/// Squared distance of a closure from the present estimate, in standard deviations of the closure.
double closureChi2(const SurveyState& state, const LoopClosure& closure) {
  const core::Isometry estimated =
      state.keyframes[closure.from].T_map_vehicle.inverse() * state.keyframes[closure.to].T_map_vehicle;
  const core::Isometry E = closure.T_from_to.inverse() * estimated;
  core::Vector6 e;
  e << E.translation(), core::logSo3(E.linear());
  return e.dot(closure.covariance.ldlt().solve(e));
}

}  // namespace

class GraphSlam::Impl {
 public:
  Impl(const GraphSlamOptions& options, std::unique_ptr<PriorMap> prior)
      : options_(options),
        lidar_(options.consistency),
        acoustic_(options.consistency),
        search_(options.loops, options.places),
        verifier_(options.loops, options.registration),
        falseClosures_(options.falseClosures, options.loops, options.consistency, options.registration),
        relocaliser_(std::move(prior), options.relocation, options.consistency),
        sonar_(options.sonar) {}

  KeyframeUpdate addKeyframe(const KeyframeInput& input);
  void addGnss(const GnssFix& fix);
  void addSubmap(const AcousticSubmap& submap);
  ClosureStatus offerClosure(const LoopClosure& closure);
  SolveSummary optimizeNow();
  GraphStatistics statistics() const;
  PoseGraph poseGraph() const;
  std::optional<core::Matrix6> marginalCovariance(int keyframe) const;

  SurveyState state_;
  GnssReport gnss_;
  std::optional<double> waterHeight_m_;
  RelocationReport relocation() const { return relocaliser_.report(); }

 private:
  void appendKeyframe(const KeyframeInput& input);
  void searchClosures(KeyframeUpdate& update);
  /// Closures of one kind, and which of them agree with each other. Each kind is judged by itself, so that what the
  /// sonars say never turns the choice among the LiDAR's.
  struct Choice {
    explicit Choice(const ConsistencyOptions& options) : consistency(options) {}
    ConsistencySet consistency;
    std::vector<int> considered;  ///< number in state_.closures of each closure in it
  };
  void consider(LoopClosure closure, Choice& choice);
  int apply(const Choice& choice);
  bool optimisationDue() const;
  bool isFarOff(const Choice& choice) const;
  SolveSummary solve();
  void takeResult(const SurveyProblem& problem);
  bool isAground(const SurveyProblem& problem);
  int dropContradictions(Choice& choice);

  GraphSlamOptions options_;
  Choice lidar_, acoustic_;
  LoopSearch search_;
  ClosureVerifier verifier_;
  FalseClosureSource falseClosures_;
  Relocaliser relocaliser_;
  SonarSearch sonar_;
  GraphStatistics statistics_;
  int waiting_ = 0;  ///< changes of the closure set since the last optimisation
  mutable std::unique_ptr<Marginals> marginals_;
};

void GraphSlam::Impl::appendKeyframe(const KeyframeInput& input) {
  if (!input.T_odom_vehicle.matrix().allFinite())
    throw core::InputError("the pose of a keyframe is not finite", core::formatUtc(input.time),
                           "pass only poses that the odometry reports as valid");
  if (!state_.keyframes.empty() && input.time <= state_.keyframes.back().time)
    throw core::InputError("a keyframe is not later than the one before", core::formatUtc(input.time),
                           "pass keyframes in time order");
  Keyframe keyframe{static_cast<int>(state_.keyframes.size()), input.time, input.T_odom_vehicle, input.T_odom_vehicle};
  double travelled_m = 0;
  if (!state_.keyframes.empty()) {
    const Keyframe& last = state_.keyframes.back();
    const core::Isometry motion = last.T_odom_vehicle.inverse() * input.T_odom_vehicle;
    keyframe.T_map_vehicle = last.T_map_vehicle * motion;
    travelled_m = motion.translation().norm();
  }
  state_.keyframes.push_back(keyframe);
  state_.clouds_vehicle.push_back(
      voxelDownsampleTo(input.cloud_vehicle, options_.cloudVoxel_m, static_cast<std::size_t>(options_.cloudPoints)));
  state_.gravity.push_back(input.gravity);
  state_.chain.append(input.T_odom_vehicle,
                      flooredCovariance(input.motionCovariance, travelled_m, options_.consistency));
  marginals_.reset();
}

KeyframeUpdate GraphSlam::Impl::addKeyframe(const KeyframeInput& input) {
  appendKeyframe(input);
  KeyframeUpdate update;
  update.id = state_.keyframes.back().id;
  search_.add(state_);
  if (search_.due(state_)) searchClosures(update);
  const RelocationChange relocation = relocaliser_.add(state_);
  if (relocation == RelocationChange::some) ++waiting_;
  if (relocation == RelocationChange::moved || optimisationDue())
    update.optimised = solve().status != SolveStatus::failed;
  return update;
}

void GraphSlam::Impl::searchClosures(KeyframeUpdate& update) {
  for (const ClosureCandidate& candidate : search_.find(state_)) {
    ++update.candidates;
    consider(verifier_.verify(state_, candidate), lidar_);
  }
  for (const LoopClosure& closure : falseClosures_.make(state_, update.candidates)) consider(closure, lidar_);
  update.accepted = apply(lidar_);
}

/// Checks a closure against odometry and takes it into the choice.
void GraphSlam::Impl::consider(LoopClosure closure, Choice& choice) {
  closure.odometryChi2 = odometryChi2(state_.chain, closure);
  if (closure.status == ClosureStatus::pending && closure.odometryChi2 > options_.consistency.chi2)
    closure.status = ClosureStatus::rejectedByOdometry;
  state_.closures.push_back(closure);
  if (closure.status != ClosureStatus::pending) return;
  choice.consistency.add(state_.chain, closure);
  choice.considered.push_back(static_cast<int>(state_.closures.size()) - 1);
}

/// Gives every closure of a kind the status that follows from the present choice; returns how many are newly accepted.
int GraphSlam::Impl::apply(const Choice& choice) {
  int accepted = 0;
  const std::vector<bool>&chosen = choice.consistency.chosen(), &waiting = choice.consistency.waiting();
  for (std::size_t c = 0; c < choice.considered.size(); ++c) {
    ClosureStatus& status = state_.closures[choice.considered[c]].status;
    if (status == ClosureStatus::rejectedByOptimiser) continue;
    const ClosureStatus unchosen = waiting[c] ? ClosureStatus::pending : ClosureStatus::rejectedByOthers;
    const ClosureStatus now = chosen[c] ? ClosureStatus::accepted : unchosen;
    if (now == ClosureStatus::accepted && status != now) ++accepted;
    if ((now == ClosureStatus::accepted) != (status == ClosureStatus::accepted)) ++waiting_;
    status = now;
  }
  return accepted;
}

bool GraphSlam::Impl::optimisationDue() const {
  if (waiting_ == 0) return false;
  return waiting_ >= options_.optimizeAtCount || isFarOff(lidar_) || isFarOff(acoustic_);
}

/// True if one of the newest accepted closures contradicts the present estimate.
bool GraphSlam::Impl::isFarOff(const Choice& choice) const {
  const double limit = options_.optimizeAt_sigma * options_.optimizeAt_sigma;
  for (std::size_t c = choice.considered.size(); c-- > 0 && choice.considered.size() - c <= 10;) {
    const LoopClosure& closure = state_.closures[choice.considered[c]];
    if (closure.status == ClosureStatus::accepted && closureChi2(state_, closure) > limit) return true;
  }
  return false;
}

/// Optimises, and again without the closures that the result contradicts.
SolveSummary GraphSlam::Impl::solve() {
  constexpr int kRounds = 3;
  SolveSummary summary;
  for (int round = 0; round < kRounds; ++round) {
    const auto start = Clock::now();
    SurveyProblem problem = makeSurveyProblem(state_, options_);
    summary = problem.graph->solve(options_.optimizer);
    if (summary.status != SolveStatus::failed) takeResult(problem);
    summary.time_s = secondsSince(start);
    statistics_.last = summary;
    const bool again = summary.status != SolveStatus::failed &&
                       (isAground(problem) || dropContradictions(lidar_) + dropContradictions(acoustic_) > 0 ||
                        gnss_.state != problem.gnss.state);
    if (!again) break;
  }
  waiting_ = 0;
  marginals_.reset();
  return summary;
}

void GraphSlam::Impl::takeResult(const SurveyProblem& problem) {
  for (std::size_t k = 0; k < state_.keyframes.size(); ++k)
    state_.keyframes[k].T_map_vehicle = problem.graph->poseAt(k);
  gnss_ = assessGnss(state_.fixes, state_.keyframes, options_.gnss).report;
  if (problem.alignment) gnss_.T_enu_map = alignmentFromBlock(problem.alignment);
  waterHeight_m_.reset();
  if (!problem.waterLevels.empty()) waterHeight_m_ = *problem.waterLevels.back();
}

/// Gives the waterline prior up, and says so, if too many keyframes are off the water surface after all.
bool GraphSlam::Impl::isAground(const SurveyProblem& problem) {
  std::size_t off = 0;
  for (std::size_t k = 0; k < problem.waterLevels.size(); ++k) {
    const double height_m = state_.keyframes[k].T_map_vehicle.translation().z() - *problem.waterLevels[k];
    if (std::abs(height_m - options_.waterline.height_m) > 3 * options_.waterline.sigma_m) ++off;
  }
  const auto count = static_cast<double>(problem.waterLevels.size());
  if (static_cast<double>(off) <= options_.waterline.giveUpShare * count) return false;
  state_.offTheWater = true;
  waterHeight_m_.reset();
  return true;
}

int GraphSlam::Impl::dropContradictions(Choice& choice) {
  int dropped = 0;
  for (std::size_t c = 0; c < choice.considered.size(); ++c) {
    LoopClosure& closure = state_.closures[choice.considered[c]];
    // Three times the quantile: the robust loss has already made it powerless, and honest closures stay.
    if (closure.status != ClosureStatus::accepted || closureChi2(state_, closure) <= 3 * options_.consistency.chi2)
      continue;
    closure.status = ClosureStatus::rejectedByOptimiser;
    choice.consistency.ban(static_cast<int>(c));
    ++dropped;
  }
  if (dropped == 0) return 0;
  choice.consistency.choose();
  apply(choice);
  return dropped;
}

SolveSummary GraphSlam::Impl::optimizeNow() {
  if (state_.keyframes.empty()) return {};
  return solve();
}

void GraphSlam::Impl::addGnss(const GnssFix& fix) {
  const bool usable = fix.p_enu.allFinite() && fix.sigma_m.allFinite() && (fix.sigma_m.array() > 0).all();
  if (state_.keyframes.empty() || !usable) return;
  const Keyframe& keyframe = state_.keyframes.back();
  TiedFix tied{fix, keyframe.id, keyframe.T_odom_vehicle.inverse() * fix.T_odom_vehicle * fix.p_vehicle_antenna};
  if (!state_.fixes.empty()) {
    const Eigen::Vector3d before = state_.fixes.back().fix.T_odom_vehicle * state_.fixes.back().fix.p_vehicle_antenna;
    const Eigen::Vector3d now = fix.T_odom_vehicle * fix.p_vehicle_antenna;
    if ((now - before).norm() < options_.gnss.minSpacing_m) return;
  }
  state_.fixes.push_back(tied);
}

void GraphSlam::Impl::addSubmap(const AcousticSubmap& submap) {
  if (!options_.sonar.enabled || state_.keyframes.empty() || !submap.T_odom_vehicle.matrix().allFinite()) return;
  for (const LoopClosure& factor : sonar_.add(state_, submap)) consider(factor, acoustic_);
  apply(acoustic_);
}

ClosureStatus GraphSlam::Impl::offerClosure(const LoopClosure& closure) {
  const int count = static_cast<int>(state_.keyframes.size());
  if (closure.from < 0 || closure.to >= count || closure.from == closure.to)
    throw core::InputError("a loop closure needs two different keyframes that exist",
                           std::to_string(closure.from) + " -> " + std::to_string(closure.to),
                           "give numbers from 0 to " + std::to_string(count - 1));
  consider(closure, lidar_);
  apply(lidar_);
  const ClosureStatus status = state_.closures.back().status;
  if (optimisationDue()) solve();
  return status;
}

GraphStatistics GraphSlam::Impl::statistics() const {
  GraphStatistics statistics = statistics_;
  statistics.keyframes = static_cast<int>(state_.keyframes.size());
  statistics.submaps = sonar_.submapCount();
  for (const auto& closure : state_.closures) {
    if (closure.source == ClosureSource::sonar) {
      ++statistics.sonarCandidates;
      if (closure.status == ClosureStatus::accepted) ++statistics.sonarAccepted;
      continue;
    }
    ++statistics.candidates;
    if (closure.status == ClosureStatus::accepted)
      ++statistics.accepted;
    else if (closure.status == ClosureStatus::pending)
      ++statistics.pending;
    else
      ++statistics.rejected;
  }
  return statistics;
}

PoseGraph GraphSlam::Impl::poseGraph() const {
  PoseGraph graph;
  for (const auto& keyframe : state_.keyframes)
    graph.nodes.push_back({keyframe.id, keyframe.T_map_vehicle, keyframe.id == 0});
  for (int k = 1; k < state_.chain.size(); ++k)
    graph.constraints.push_back({k - 1, k, state_.chain.relative(k - 1, k), stepInformation(state_.chain, k)});
  for (const auto& closure : state_.closures)
    if (closure.status == ClosureStatus::accepted)
      graph.constraints.push_back({closure.from, closure.to, closure.T_from_to, closure.covariance.inverse()});
  return graph;
}

std::optional<core::Matrix6> GraphSlam::Impl::marginalCovariance(int keyframe) const {
  if (keyframe < 0 || keyframe >= static_cast<int>(state_.keyframes.size())) return std::nullopt;
  if (!marginals_) {
    const SurveyProblem problem = makeSurveyProblem(state_, options_);
    marginals_ = std::make_unique<Marginals>(*problem.graph, state_.keyframes.size());
  }
  return marginals_->of(static_cast<std::size_t>(keyframe));
}

GraphSlam::GraphSlam(const GraphSlamOptions& options, std::unique_ptr<PriorMap> prior)
    : impl_(std::make_unique<Impl>(options, std::move(prior))) {}
GraphSlam::~GraphSlam() = default;
GraphSlam::GraphSlam(GraphSlam&&) noexcept = default;

KeyframeUpdate GraphSlam::addKeyframe(const KeyframeInput& input) { return impl_->addKeyframe(input); }
void GraphSlam::addGnss(const GnssFix& fix) { impl_->addGnss(fix); }
void GraphSlam::addSubmap(const AcousticSubmap& submap) { impl_->addSubmap(submap); }
SolveSummary GraphSlam::optimizeNow() { return impl_->optimizeNow(); }
const std::vector<Keyframe>& GraphSlam::keyframes() const { return impl_->state_.keyframes; }
const std::vector<LoopClosure>& GraphSlam::loopClosures() const { return impl_->state_.closures; }
GraphStatistics GraphSlam::statistics() const { return impl_->statistics(); }
GnssReport GraphSlam::gnssReport() const { return impl_->gnss_; }
RelocationReport GraphSlam::relocationReport() const { return impl_->relocation(); }
std::optional<double> GraphSlam::waterHeight_m() const { return impl_->waterHeight_m_; }
PoseGraph GraphSlam::poseGraph() const { return impl_->poseGraph(); }
mrpt::graphs::CNetworkOfPoses3DInf GraphSlam::network() const { return toMrptNetwork(impl_->poseGraph()); }

std::optional<core::Matrix6> GraphSlam::marginalCovariance(int keyframe) const {
  return impl_->marginalCovariance(keyframe);
}

ClosureStatus GraphSlam::offerClosure(int from, int to, const core::Isometry& T_from_to,
                                      const core::Matrix6& covariance) {
  LoopClosure closure;
  const bool ordered = from <= to;
  closure.from = ordered ? from : to;
  closure.to = ordered ? to : from;
  closure.T_from_to = ordered ? T_from_to : T_from_to.inverse();
  // The inverse of T exp(d) is T^-1 exp(-Ad(T) d).
  const core::Matrix6 Ad = adjoint(T_from_to);
  closure.covariance = ordered ? covariance : core::Matrix6(Ad * covariance * Ad.transpose());
  closure.source = ClosureSource::external;
  return impl_->offerClosure(closure);
}

}  // namespace s2s::graph
