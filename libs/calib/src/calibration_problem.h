#pragma once

#include <ceres/problem.h>

#include <deque>
#include <vector>

#include "s2s/calib/calibrator.h"
#include "s2s/calib/observability.h"
#include "s2s/calib/options.h"
#include "s2s/calib/seabed_grid.h"
#include "s2s/calib/wall_residual.h"
#include "texture_association.h"

namespace s2s::calib {

/// One echo that takes part in a round.
struct UsedEcho {
  Echo echo;
  SonarId sonar = SonarId::Horizontal;
  EvidenceKind kind = EvidenceKind::NearEdge;
  const PingMotion* motion = nullptr;
  int block = 0;                  ///< of time
  SeabedGrid::Index cell;         ///< of the seabed that it lies on, ...
  SeabedGrid::Index otherCell;    ///< of a band's other point
  std::optional<WallPlane> wall;  ///< ... or the wall
  double weight_perM = 1;
};

/// All evidence of a round.
struct RoundEvidence {
  std::optional<double> verticalZ_m;  ///< correction kZ of the vertical sonar, as the water surface tells it
  std::vector<UsedEcho> echoes;
  std::vector<UsedTexture> texture;
};

/// What is known of a sonar's time offset by itself.
struct TimeEvidence {
  SonarId sonar = SonarId::Horizontal;
  double correction_s = 0, sigma_s = 1;
};

/// The least-squares problem of one round: echoes against the seabed's heights and walls, what is known
/// beforehand, and directions that are held.
class CalibrationProblem {
 public:
  /// `state` and `grid` are the variables; both must outlive the problem, as must the motions of the echoes.
  CalibrationProblem(CalibrationState& state, SeabedGrid& grid, const CalibrationOptions& options);

  /// To be called once, before anything else.
  void add(const RoundEvidence& evidence);
  void add(const TimeEvidence& evidence);
  /// Holds a combination of parameters at its nominal value.
  void hold(const WeakDirection& direction);
  /// Nothing but the seabed moves.
  void fixParameters();
  void solve(int iterations);
  /// What the evidence says about the wanted parameters.
  DataInformation information();

 private:
  void addPriors();
  void addTexture(const UsedTexture& used, double weight);
  void addEcho(const UsedEcho& used, double weight);
  void addParameter(SonarId sonar, SonarParameter parameter, double value, double sigma);
  ceres::LossFunction* loss(double weight) const;
  /// @param weight of the squares, as the echoes have on average
  void addRoughness(double weight);

  CalibrationState& state_;
  SeabedGrid& grid_;
  const CalibrationOptions& options_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> dataBlocks_, seabedBlocks_, nuisanceBlocks_;
  std::vector<int> rowTimes_;  ///< block of time of each row of the data
};

}  // namespace s2s::calib
