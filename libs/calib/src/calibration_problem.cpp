#include "calibration_problem.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/solver.h>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

namespace s2s::calib {

namespace {

/// A held direction may leave its nominal value by this share of the prior's standard deviations.
constexpr double kHeldSigma = 1e-3;
/// Heights are tied to where they started by so little that only nodes without any other hold notice.
constexpr double kLooseHeightSigma_m = 1.0;

double* of(SonarState& sonar) { return sonar.correction.data(); }

/// (x_i - nominal_i) / sigma_i for all parameters of a sonar, and the asymmetry of the aperture.
struct SonarPrior {
  SonarVector sigma;
  double asymmetrySigma;
  bool nuisancesOnly;

  template <class T>
  bool operator()(const T* const x, T* residual) const {
    for (int i = 0; i < kSonarParameters; ++i)
      residual[i] = nuisancesOnly == (i >= kWantedSonarParameters) ? x[i] / sigma[static_cast<std::size_t>(i)] : T(0);
    residual[kSonarParameters] = nuisancesOnly ? (x[kNear] - x[kFar]) / asymmetrySigma : T(0);
    return true;
  }
};

struct ScalarPrior {
  double value, sigma;
  template <class T>
  bool operator()(const T* const x, T* residual) const {
    residual[0] = (*x - value) / sigma;
    return true;
  }
};

/// What is known of a single parameter of a sonar.
struct ParameterResidual {
  SonarParameter parameter;
  double value, sigma;
  template <class T>
  bool operator()(const T* const correction, T* residual) const {
    residual[0] = (correction[parameter] - value) / sigma;
    return true;
  }
};

struct SecondDifference {
  double sigma;
  template <class T>
  bool operator()(const T* const a, const T* const b, const T* const c, T* residual) const {
    residual[0] = (*a - 2.0 * *b + *c) / sigma;
    return true;
  }
};

struct HeldDirection {
  WantedVector direction_perUnit;  ///< direction over the prior's standard deviations
  double nominalSoundSpeed_mps;

  template <class T>
  bool operator()(const T* const h, const T* const v, const T* const soundSpeed, T* residual) const {
    T along = (*soundSpeed - nominalSoundSpeed_mps) * direction_perUnit[kWanted - 1];
    for (int i = 0; i < kWantedSonarParameters; ++i)
      along += h[i] * direction_perUnit[i] + v[i] * direction_perUnit[i + kWantedSonarParameters];
    residual[0] = along / kHeldSigma;
    return true;
  }
};

SonarVector priorSigmas(const CalibrationOptions& o, SonarId id) {
  // An upright plane's middle may wander along the fan as much as it may be off.
  const double bend = id == SonarId::Vertical ? o.apertureSigma_rad : o.apertureBendSigma_rad;
  return {o.positionSigma_m,
          o.positionSigma_m,
          o.positionSigma_m,
          o.rotationSigma_rad,
          o.rotationSigma_rad,
          o.rotationSigma_rad,
          o.timeSigma_s,
          o.apertureSigma_rad,
          o.apertureSigma_rad,
          bend,
          o.apertureBendSigma_rad,
          o.rangeSigma_m,
          o.rangeScaleSigma,
          o.rangeBearingSigma_m,
          2 * o.rangeBearingSigma_m,
          o.texture.tiltSigma_mPerRad,
          o.aperture.widthSigma_rad,
          o.aperture.widthBendSigma_rad,
          o.aperture.axisSigma_rad};
}

using SparseMatrix = Eigen::SparseMatrix<double>;

SparseMatrix toEigen(const ceres::CRSMatrix& crs) {
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows(crs.num_rows, crs.num_cols);
  rows = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      crs.num_rows, crs.num_cols, static_cast<Eigen::Index>(crs.values.size()), crs.rows.data(), crs.cols.data(),
      crs.values.data());
  return rows;
}

}  // namespace

CalibrationProblem::CalibrationProblem(CalibrationState& state, SeabedGrid& grid, const CalibrationOptions& options)
    : state_(state), grid_(grid), options_(options) {
  for (SonarState& sonar : state_.sonars) problem_.AddParameterBlock(of(sonar), kSonarParameters);
  problem_.AddParameterBlock(&state_.soundSpeed_mps, 1);
  for (double* height : grid_.nodes()) problem_.AddParameterBlock(height, 1);
  addPriors();
}

void CalibrationProblem::addPriors() {
  for (const SonarId id : kSonars)
    for (const bool nuisances : {false, true}) {
      auto* prior = new ceres::AutoDiffCostFunction<SonarPrior, kSonarParameters + 1, kSonarParameters>(
          new SonarPrior{priorSigmas(options_, id), options_.apertureAsymmetrySigma_rad, nuisances});
      const auto block = problem_.AddResidualBlock(prior, nullptr, of(state_[id]));
      if (nuisances) nuisanceBlocks_.push_back(block);
    }
  problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<ScalarPrior, 1, 1>(
                                new ScalarPrior{state_.nominalSoundSpeed_mps, options_.soundSpeedSigma_mps}),
                            nullptr, &state_.soundSpeed_mps);
}

void CalibrationProblem::addRoughness(double weight) {
  const double scale = 1 / std::sqrt(weight);
  for (const auto& [a, b, c] : grid_.triples())
    seabedBlocks_.push_back(problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<SecondDifference, 1, 1, 1, 1>(
                                                          new SecondDifference{options_.roughness_m * scale}),
                                                      nullptr, a, b, c));
  for (double* height : grid_.nodes())
    seabedBlocks_.push_back(problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<ScalarPrior, 1, 1>(new ScalarPrior{*height, kLooseHeightSigma_m * scale}),
        nullptr, height));
}

ceres::LossFunction* CalibrationProblem::loss(double weight) const {
  return new ceres::ScaledLoss(new ceres::CauchyLoss(options_.lossWidth), weight, ceres::TAKE_OWNERSHIP);
}

void CalibrationProblem::addEcho(const UsedEcho& used, double weight) {
  SonarState& sonar = state_[used.sonar];
  rowTimes_.push_back(used.block);
  if (used.wall) {
    auto* cost = new ceres::AutoDiffCostFunction<WallResidual, 1, kSonarParameters, 1>(
        new WallResidual{used.echo, &sonar, used.motion, used.wall->normal, used.wall->offset_m, used.weight_perM});
    dataBlocks_.push_back(problem_.AddResidualBlock(cost, loss(weight), of(sonar), &state_.soundSpeed_mps));
    return;
  }
  const auto [h00, h10, h01, h11] = grid_.corners(used.cell);
  const SeabedResidual residual{used.echo,      &sonar,          used.motion, grid_.corner_m(used.cell),
                                grid_.cell_m(), used.weight_perM};
  if (used.echo.kind == EchoKind::Band) {
    const auto [k00, k10, k01, k11] = grid_.corners(used.otherCell);
    auto* band = new ceres::AutoDiffCostFunction<BandResidual, 1, kSonarParameters, 1, 1, 1, 1, 1, 1, 1, 1, 1>(
        new BandResidual{residual, grid_.corner_m(used.otherCell)});
    dataBlocks_.push_back(problem_.AddResidualBlock(band, loss(weight), of(sonar), &state_.soundSpeed_mps, h00, h10,
                                                    h01, h11, k00, k10, k01, k11));
    return;
  }
  auto* cost =
      new ceres::AutoDiffCostFunction<SeabedResidual, 1, kSonarParameters, 1, 1, 1, 1, 1>(new SeabedResidual(residual));
  dataBlocks_.push_back(
      problem_.AddResidualBlock(cost, loss(weight), of(sonar), &state_.soundSpeed_mps, h00, h10, h01, h11));
}

void CalibrationProblem::addTexture(const UsedTexture& used, double weight) {
  auto* cost = new ceres::AutoDiffCostFunction<TextureResidual, 2, kSonarParameters, 1, 1, 1, 1, 1>(
      new TextureResidual(used.residual));
  dataBlocks_.push_back(problem_.AddResidualBlock(cost, loss(weight), of(state_[SonarId::Horizontal]),
                                                  &state_.soundSpeed_mps, used.nodes[0], used.nodes[1], used.nodes[2],
                                                  used.nodes[3]));
  rowTimes_.insert(rowTimes_.end(), 2, used.block);
}

void CalibrationProblem::add(const RoundEvidence& evidence) {
  std::array<double, kEvidenceKinds> counts{}, weights{};
  for (const UsedEcho& used : evidence.echoes) ++counts[static_cast<std::size_t>(used.kind)];
  counts[static_cast<std::size_t>(EvidenceKind::Texture)] = static_cast<double>(evidence.texture.size());
  double together = 0, all = 0;
  for (std::size_t k = 0; k < kEvidenceKinds; ++k) {
    weights[k] = std::min(1.0, 1 / (counts[k] * options_.commonShare * options_.commonShare));
    if (counts[k] > 0) together += counts[k] * weights[k];
    all += counts[k];
  }
  for (const UsedEcho& used : evidence.echoes) addEcho(used, weights[static_cast<std::size_t>(used.kind)]);
  for (const UsedTexture& used : evidence.texture)
    addTexture(used, weights[static_cast<std::size_t>(EvidenceKind::Texture)]);
  if (evidence.verticalZ_m) addParameter(SonarId::Vertical, kZ, *evidence.verticalZ_m, options_.mirror.sigma_m);
  addRoughness(together / std::max(1.0, all));
}

void CalibrationProblem::add(const TimeEvidence& evidence) {
  addParameter(evidence.sonar, kTime, evidence.correction_s, evidence.sigma_s);
}

void CalibrationProblem::addParameter(SonarId sonar, SonarParameter parameter, double value, double sigma) {
  dataBlocks_.push_back(
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<ParameterResidual, 1, kSonarParameters>(
                                    new ParameterResidual{parameter, value, sigma}),
                                nullptr, of(state_[sonar])));
  rowTimes_.push_back(0);
}

void CalibrationProblem::hold(const WeakDirection& direction) {
  WantedVector perUnit;
  for (int i = 0; i < kWanted; ++i) perUnit[i] = direction.direction[i] / priorSigmaOf(i, options_);
  problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<HeldDirection, 1, kSonarParameters, kSonarParameters, 1>(
                                new HeldDirection{perUnit, state_.nominalSoundSpeed_mps}),
                            nullptr, of(state_.sonars[0]), of(state_.sonars[1]), &state_.soundSpeed_mps);
}

void CalibrationProblem::fixParameters() {
  for (SonarState& sonar : state_.sonars) problem_.SetParameterBlockConstant(of(sonar));
  problem_.SetParameterBlockConstant(&state_.soundSpeed_mps);
}

void CalibrationProblem::solve(int iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = iterations;
  options.num_threads = options_.threads;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
}

DataInformation CalibrationProblem::information() {
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = {of(state_.sonars[0]), of(state_.sonars[1]), &state_.soundSpeed_mps};
  for (double* height : grid_.nodes()) evaluate.parameter_blocks.push_back(height);
  evaluate.residual_blocks = dataBlocks_;
  for (const auto* more : {&nuisanceBlocks_, &seabedBlocks_})
    evaluate.residual_blocks.insert(evaluate.residual_blocks.end(), more->begin(), more->end());
  evaluate.num_threads = options_.threads;
  std::vector<double> residuals;
  ceres::CRSMatrix crs;
  problem_.Evaluate(evaluate, nullptr, &residuals, nullptr, &crs);
  const SparseMatrix J = toEigen(crs);

  // Marginalise the seabed: reduced rows Z = Jp - Jn Hnn^-1 Jn^T Jp.
  constexpr int kDense = 2 * kSonarParameters + 1;
  const Eigen::MatrixXd Jp = J.leftCols(kDense);
  const SparseMatrix Jn = J.rightCols(J.cols() - kDense);
  const Eigen::SimplicialLDLT<SparseMatrix> Hnn(SparseMatrix(Jn.transpose() * Jn));
  const Eigen::MatrixXd Z = Jp - Jn * Hnn.solve(Jn.transpose() * Jp);

  // Then the nuisances of both sonars.
  std::vector<int> wanted, nuisance;
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < kSonarParameters; ++i)
      (i < kWantedSonarParameters ? wanted : nuisance).push_back(s * kSonarParameters + i);
  wanted.push_back(kDense - 1);
  const Eigen::MatrixXd A = Z.transpose() * Z;
  const Eigen::MatrixXd Aqq = A(nuisance, nuisance), Aqp = A(nuisance, wanted);
  const Eigen::MatrixXd X = Aqq.ldlt().solve(Aqp);
  const Eigen::MatrixXd reduced = Z(Eigen::all, wanted) - Z(Eigen::all, nuisance) * X;

  DataInformation data;
  data.information = reduced.transpose() * reduced;
  std::vector<WantedVector> gradients;
  for (std::size_t k = 0; k < rowTimes_.size(); ++k) {
    const auto block = static_cast<std::size_t>(rowTimes_[k]);
    if (gradients.size() <= block) gradients.resize(block + 1, WantedVector::Zero());
    gradients[block] += reduced.row(static_cast<Eigen::Index>(k)).transpose() * residuals[k];
  }
  for (const WantedVector& g : gradients) data.scatter += g * g.transpose();
  return data;
}

}  // namespace s2s::calib
