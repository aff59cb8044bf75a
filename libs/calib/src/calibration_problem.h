#pragma once

#include <ceres/problem.h>

#include <deque>
#include <vector>

#include "s2s/calib/observability.h"
#include "s2s/calib/options.h"
#include "s2s/calib/seabed_grid.h"
#include "s2s/calib/surface_residual.h"

namespace s2s::calib {

/// One echo that takes part in a round.
struct UsedEcho {
  Echo echo;
  SonarId sonar = SonarId::Horizontal;
  const PingMotion* motion = nullptr;
  int block = 0;  ///< of time
  SeabedGrid::Index cell;
  double weight_perM = 1;
};

/// The least-squares problem of one round: echoes against the seabed's heights, what is known beforehand, and
/// directions that are held.
class CalibrationProblem {
 public:
  /// `state` and `grid` are the variables; both must outlive the problem, as must the motions of the echoes.
  CalibrationProblem(CalibrationState& state, SeabedGrid& grid, const CalibrationOptions& options);

  /// To be called once, before anything else.
  void addEchoes(const std::vector<UsedEcho>& echoes);
  /// Holds a combination of parameters at its nominal value.
  void hold(const WeakDirection& direction);
  /// Nothing but the seabed moves.
  void fixParameters();
  void solve(int iterations);
  /// What the echoes say about the wanted parameters. @param echoes those of `addEchoes`, in their order
  DataInformation information(const std::vector<UsedEcho>& echoes);

 private:
  void addPriors();
  /// @param weight of the squares, as the echoes have on average
  void addRoughness(double weight);

  CalibrationState& state_;
  SeabedGrid& grid_;
  const CalibrationOptions& options_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> echoBlocks_, seabedBlocks_, nuisanceBlocks_;
};

}  // namespace s2s::calib
