#include "s2s/calib/calibrator.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "calibration_problem.h"
#include "s2s/core/error.h"

namespace s2s::calib {

namespace {

constexpr double kStep_s = 0.01;        // for velocities
constexpr double kMaxPoseGap_s = 0.5;   // of the trajectory
constexpr double kMaxRate_radps = 2;    // faster than this no vessel moves: the trajectory jumps there, ...
constexpr double kMaxSpeed_mps = 20;    // ... and its derivative would tell times that are not true
constexpr double kFirstSigma_m = 0.1;   // of ranges, before anything is known
constexpr double kLeastSigma_m = 0.02;  // no echo is better than a resolution cell
constexpr double kLeastSlope = 0.15;  // metres of height per metre of range: echoes that graze the seabed count little
constexpr int kIterations = 5;        // within a round; the next one starts from there
constexpr std::size_t kMinEchoes = 500;

std::optional<PingMotion> motionAt(const core::Trajectory& T_map_vehicle, core::TimeNs time, double correction_s) {
  const auto T = T_map_vehicle.at(time, kMaxPoseGap_s);
  const auto before = T_map_vehicle.at(time - core::durationNs(kStep_s), kMaxPoseGap_s);
  const auto after = T_map_vehicle.at(time + core::durationNs(kStep_s), kMaxPoseGap_s);
  if (!T || !before || !after) return {};
  PingMotion motion;
  motion.T_map_vehicle = *T;
  motion.velocity_mps = T->linear().transpose() * (after->translation() - before->translation()) / (2 * kStep_s);
  motion.rate_radps = core::logSo3(before->linear().transpose() * after->linear()) / (2 * kStep_s);
  motion.timeOffset_s = correction_s;
  if (motion.rate_radps.norm() > kMaxRate_radps || motion.velocity_mps.norm() > kMaxSpeed_mps) return {};
  return motion;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The rounds of association and estimation.
class Rounds {
 public:
  Rounds(const CalibrationState& nominal, const std::vector<PingEchoes>& pings, const core::Trajectory& trajectory,
         const CalibrationOptions& options)
      : state_(nominal), pings_(pings), trajectory_(trajectory), options_(options), grid_(options.cell_m) {
    std::size_t total = 0;
    for (const auto& ping : pings_) total += ping.echoes.size();
    stride_ = 1 + total / static_cast<std::size_t>(std::max(1, options_.maxEchoes));
    sigma_.fill(kFirstSigma_m);
  }

  void round(double gate_m, const std::vector<WeakDirection>& held) {
    place();
    associate(gate_m);
    CalibrationProblem problem(state_, grid_, options_);
    problem.addEchoes(used_);
    for (const auto& direction : held) problem.hold(direction);
    problem.solve(kIterations);
  }

  /// The seabed alone, under the present parameters.
  void seabedOnly(double gate_m) {
    place();
    associate(gate_m);
    CalibrationProblem problem(state_, grid_, options_);
    problem.addEchoes(used_);
    problem.fixParameters();
    problem.solve(kIterations);
  }

  DataInformation information(double gate_m) {
    place();
    associate(gate_m);
    CalibrationProblem problem(state_, grid_, options_);
    problem.addEchoes(used_);
    return problem.information(used_);
  }

  const CalibrationState& state() const { return state_; }
  CalibrationStatistics statistics() const {
    CalibrationStatistics all;
    all.echoes = counts_;
    all.leftOut = leftOut_;
    all.rangeSigma_m = sigma_;
    return all;
  }

 private:
  struct Placed {
    UsedEcho used;
    Eigen::Vector3d p_map, p_farther_map;  ///< p_farther: a metre further out
  };

  bool wanted(const Echo& echo) const {
    const double limit_rad = echo.kind == EchoKind::FarEdge ? options_.farEdgeBearing_rad : options_.maxBearing_rad;
    return std::abs(echo.bearing_rad) <= limit_rad;
  }

  /// Places all echoes by the present state and fits the grid to where they are.
  void place() {
    motions_.clear();
    placed_.clear();
    std::array<std::size_t, 2> number{};
    for (const auto& ping : pings_) {
      const SonarState& sonar = state_[ping.sonar];
      if (number[static_cast<std::size_t>(ping.sonar)]++ % stride_ != 0) continue;
      const auto motion =
          motionAt(trajectory_, ping.time - core::durationNs(sonar.correctedTimeOffset_s()), sonar.correction[kTime]);
      if (!motion) continue;
      motions_.push_back(std::make_unique<PingMotion>(*motion));
      placePing(ping, sonar, *motions_.back());
    }
    std::vector<Eigen::Vector3d> points;
    points.reserve(placed_.size());
    for (const auto& placed : placed_) points.push_back(placed.p_map);
    grid_.fit(points, options_.minCellEchoes);
  }

  void placePing(const PingEchoes& ping, const SonarState& sonar, const PingMotion& motion) {
    const int block = static_cast<int>(core::secondsBetween(trajectory_.front().time, ping.time) / options_.block_s);
    for (const Echo& echo : ping.echoes) {
      if (!wanted(echo)) continue;
      Placed placed;
      placed.used.echo = echo;
      placed.used.sonar = ping.sonar;
      placed.used.motion = &motion;
      placed.used.block = std::max(0, block);
      placed.p_map = echoPoint<double>(echo, sonar, motion, sonar.correction.data(), state_.soundSpeed_mps);
      Echo farther = echo;
      farther.range_m += 1;
      placed.p_farther_map = echoPoint<double>(farther, sonar, motion, sonar.correction.data(), state_.soundSpeed_mps);
      if (placed.p_map.allFinite()) placed_.push_back(placed);
    }
  }

  /// Chooses the echoes near the seabed and gives them their weights.
  void associate(double gate_m) {
    used_.clear();
    counts_.fill(0);
    leftOut_.fill(0);
    std::array<std::vector<double>, kEchoKinds> spreads;
    for (Placed& placed : placed_) {
      const auto kind = static_cast<std::size_t>(placed.used.echo.kind);
      const auto seabed = grid_.at(placed.p_map.x(), placed.p_map.y());
      const double gap_m = seabed ? placed.p_map.z() - seabed->height_m : 0;
      const Eigen::Vector3d ray = placed.p_farther_map - placed.p_map;
      const double slope = seabed ? std::abs(ray.z() - seabed->slope.dot(ray.head<2>())) : 0;
      if (!seabed || std::abs(gap_m) > gate_m || slope < kLeastSlope) {
        ++leftOut_[kind];
        continue;
      }
      ++counts_[kind];
      spreads[kind].push_back(std::abs(gap_m) / slope);
      placed.used.cell = grid_.cellOf(placed.p_map.x(), placed.p_map.y());
      placed.used.weight_perM = 1 / (sigma_[kind] * slope);
      used_.push_back(placed.used);
    }
    rescale(spreads);
    if (used_.size() < kMinEchoes)
      throw core::InputError("only " + std::to_string(used_.size()) + " echoes of the seabed were found", "calibration",
                             "look at the pings with sonar-inspect; take a longer part of the survey");
  }

  /// Weights by the spread that the echoes have around the seabed now.
  void rescale(std::array<std::vector<double>, kEchoKinds>& spreads) {
    std::array<double, kEchoKinds> factor{};
    for (std::size_t kind = 0; kind < kEchoKinds; ++kind) {
      const double old = sigma_[kind];
      if (!spreads[kind].empty()) sigma_[kind] = std::max(kLeastSigma_m, 1.4826 * median(spreads[kind]));
      factor[kind] = old / sigma_[kind];
    }
    for (UsedEcho& used : used_) used.weight_perM *= factor[static_cast<std::size_t>(used.echo.kind)];
  }

  CalibrationState state_;
  const std::vector<PingEchoes>& pings_;
  const core::Trajectory& trajectory_;
  const CalibrationOptions& options_;
  SeabedGrid grid_;
  std::size_t stride_ = 1;
  std::vector<std::unique_ptr<PingMotion>> motions_;
  std::vector<Placed> placed_;
  std::vector<UsedEcho> used_;
  std::array<double, kEchoKinds> sigma_{};
  std::array<std::size_t, kEchoKinds> counts_{}, leftOut_{};
};

}  // namespace

CalibrationResult calibrate(const CalibrationState& nominal, const std::vector<PingEchoes>& pings,
                            const core::Trajectory& T_map_vehicle, const CalibrationOptions& options,
                            const std::function<void(int, int)>& onRound) {
  if (T_map_vehicle.empty()) throw core::InputError("the survey has no trajectory", "calibration", "check the LiDAR");
  Rounds rounds(nominal, pings, T_map_vehicle, options);
  const int total = options.rounds + 4;
  int done = 0;
  const auto tell = [&] {
    if (onRound) onRound(++done, total);
  };
  rounds.seabedOnly(options.firstGate_m);
  tell();
  for (int k = 0; k < options.rounds; ++k) {
    const double share = options.rounds > 1 ? static_cast<double>(k) / (options.rounds - 1) : 1;
    rounds.round(options.firstGate_m + share * (options.lastGate_m - options.firstGate_m), {});
    tell();
  }
  CalibrationResult result;
  result.observability = assess(rounds.information(options.lastGate_m), options);
  tell();
  for (int k = 0; k < 2; ++k) {
    rounds.round(options.lastGate_m, result.observability.weak);
    tell();
  }
  result.state = rounds.state();
  result.statistics = rounds.statistics();
  return result;
}

}  // namespace s2s::calib
