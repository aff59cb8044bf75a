#include "s2s/calib/calibrator.h"

#include "association.h"
#include "s2s/core/error.h"

namespace s2s::calib {

namespace {

constexpr int kMirrorRound = 2;   // the sonar's pitch has to be roughly known first
constexpr int kTextureRound = 1;  // the bed has to be roughly known first
constexpr int kIterations = 5;    // within a round; the next one starts from there

/// The rounds of association and estimation.
class Rounds {
 public:
  Rounds(const CalibrationState& nominal, const CalibrationEvidence& evidence, const CalibrationOptions& options)
      : state_(nominal), options_(options), grid_(options.cell_m), association_(evidence, options) {}

  void round(const RoundGates& gates, const std::vector<WeakDirection>& held) {
    association_.update(state_, grid_, gates);
    CalibrationProblem problem(state_, grid_, options_);
    problem.add(association_.used());
    for (const auto& direction : held) problem.hold(direction);
    problem.solve(kIterations);
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
    return problem.information();
  }

  const CalibrationState& state() const { return state_; }
  CalibrationStatistics statistics() const { return association_.statistics(); }

 private:
  CalibrationState state_;
  const CalibrationOptions& options_;
  SeabedGrid grid_;
  Association association_;
};

/// From wide to narrow.
RoundGates gatesOf(int round, const CalibrationOptions& options) {
  const double share = options.rounds > 1 ? static_cast<double>(round) / (options.rounds - 1) : 1;
  RoundGates gates;
  gates.echo_m = options.firstGate_m + share * (options.lastGate_m - options.firstGate_m);
  if (round >= kTextureRound)
    gates.texture_m =
        options.texture.firstReach_m + share * (options.texture.lastReach_m - options.texture.firstReach_m);
  gates.mirror = round >= kMirrorRound;
  return gates;
}

}  // namespace

CalibrationResult calibrate(const CalibrationState& nominal, const CalibrationEvidence& evidence,
                            const CalibrationOptions& options, const std::function<void(int, int)>& onRound) {
  if (evidence.T_map_vehicle.empty())
    throw core::InputError("the survey has no trajectory", "calibration", "check the LiDAR");
  Rounds rounds(nominal, evidence, options);
  const int total = options.rounds + 4;
  int done = 0;
  const auto tell = [&] {
    if (onRound) onRound(++done, total);
  };
  rounds.seabedOnly({options.firstGate_m, 0, false});
  tell();
  for (int k = 0; k < options.rounds; ++k) {
    rounds.round(gatesOf(k, options), {});
    tell();
  }
  CalibrationResult result;
  const RoundGates last = gatesOf(options.rounds - 1, options);
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
