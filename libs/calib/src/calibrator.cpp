#include "s2s/calib/calibrator.h"

#include "association.h"
#include "s2s/core/error.h"

namespace s2s::calib {

namespace {

constexpr int kMirrorRound = 2;    // the sonar's pitch has to be roughly known first
constexpr int kApertureRound = 3;  // the ends have to be within the window in which they are looked for
constexpr int kTextureRound = 1;   // the bed has to be roughly known first
constexpr int kIterations = 5;     // within a round; the next one starts from there

/// The rounds of association and estimation.
class Rounds {
 public:
  Rounds(const CalibrationState& nominal, const CalibrationEvidence& evidence, const CalibrationOptions& options)
      : state_(nominal), options_(options), grid_(options.cell_m), association_(evidence, options) {}

  void round(const RoundGates& gates, const std::vector<WeakDirection>& held) {
    association_.update(state_, grid_, gates);
    CalibrationProblem problem(state_, grid_, options_);
    problem.add(association_.used());
    for (const auto& time : times_) problem.add(time);
    for (const auto& direction : held) problem.hold(direction);
    problem.solve(kIterations);
  }

  /// Time offsets by all echoes at nearly their full weight; all else stays as it was.
  void findTimes(const RoundGates& gates) {
    association_.update(state_, grid_, gates);
    const CalibrationState before = state_;
    std::vector<double> heights_m;
    for (const double* height_m : grid_.nodes()) heights_m.push_back(*height_m);
    CalibrationOptions options = options_;
    options.commonShare = std::min(options.commonShare, options.timeCommonShare);
    CalibrationProblem problem(state_, grid_, options);
    problem.add(association_.used());
    problem.solve(kIterations);
    const Observability told = assess(problem.information(), options);
    for (const SonarId id : kSonars) {
      const int time = static_cast<int>(id) * kWantedSonarParameters + kTime;
      const auto& verdict = told.parameters[static_cast<std::size_t>(time)];
      if (verdict.verdict != Verdict::Unobservable) times_.push_back({id, state_[id].correction[kTime], verdict.sigma});
    }
    state_ = before;
    const auto nodes = grid_.nodes();
    for (std::size_t n = 0; n < nodes.size(); ++n) *nodes[n] = heights_m[n];
  }

  /// The seabed alone, under the present parameters.
  void seabedOnly(const RoundGates& gates) {
    association_.update(state_, grid_, gates);
    CalibrationProblem problem(state_, grid_, options_);
    problem.add(association_.used());
    problem.fixParameters();
    problem.solve(kIterations);
  }

  DataInformation information(const RoundGates& gates) {
    association_.update(state_, grid_, gates);
    CalibrationProblem problem(state_, grid_, options_);
    problem.add(association_.used());
    for (const auto& time : times_) problem.add(time);
    return problem.information();
  }

  const CalibrationState& state() const { return state_; }
  CalibrationStatistics statistics() const { return association_.statistics(); }

 private:
  CalibrationState state_;
  const CalibrationOptions& options_;
  SeabedGrid grid_;
  Association association_;
  std::vector<TimeEvidence> times_;
};

/// From wide to narrow.
RoundGates gatesOf(int round, const CalibrationOptions& options) {
  const double share = options.rounds > 1 ? static_cast<double>(round) / (options.rounds - 1) : 1;
  RoundGates gates;
  gates.echo_m = options.firstGate_m + share * (options.lastGate_m - options.firstGate_m);
  if (round >= kTextureRound)
    gates.texture_m =
        options.texture.firstReach_m + share * (options.texture.lastReach_m - options.texture.firstReach_m);
  gates.aperture = round >= kApertureRound;
  gates.mirror = round >= kMirrorRound;
  return gates;
}

}  // namespace

CalibrationResult calibrate(const CalibrationState& nominal, const CalibrationEvidence& evidence,
                            const CalibrationOptions& options, const std::function<void(int, int)>& onRound) {
  if (evidence.T_map_vehicle.empty())
    throw core::InputError("the survey has no trajectory", "calibration", "check the LiDAR");
  Rounds rounds(nominal, evidence, options);
  const int total = options.rounds + 6;
  int done = 0;
  const auto tell = [&] {
    if (onRound) onRound(++done, total);
  };
  rounds.seabedOnly({options.firstGate_m});
  tell();
  for (int k = 0; k < options.rounds; ++k) {
    rounds.round(gatesOf(k, options), {});
    tell();
  }
  CalibrationResult result;
  const RoundGates last = gatesOf(options.rounds - 1, options);
  rounds.findTimes(last);
  tell();
  rounds.round(last, {});
  tell();
  result.observability = assess(rounds.information(last), options);
  tell();
  for (int k = 0; k < 2; ++k) {
    rounds.round(last, result.observability.weak);
    tell();
  }
  result.state = rounds.state();
  result.statistics = rounds.statistics();
  return result;
}

}  // namespace s2s::calib
