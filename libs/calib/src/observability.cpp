#include "s2s/calib/observability.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace s2s::calib {

namespace {

/// A parameter may lie along weak directions by this share (cosine) and still count as observable: most of it is known.
constexpr double kMaxWeakShare = 0.3;
/// Eigenvalues below this are taken as it: ten thousand times what was known before is unknown all the same.
constexpr double kSmallestInformation = 1e-8;

WantedMatrix priors(const CalibrationOptions& options) {
  WantedVector scale;
  for (int i = 0; i < kWanted; ++i) scale[i] = priorSigmaOf(i, options);
  return scale.asDiagonal();
}

/// Covariance in units of the prior: model and sandwich, the larger along each of the model's axes.
WantedMatrix scaledCovariance(const DataInformation& data, const WantedMatrix& D) {
  const Eigen::SelfAdjointEigenSolver<WantedMatrix> eigen(D * data.information * D);
  const WantedMatrix& V = eigen.eigenvectors();
  const WantedVector variance = eigen.eigenvalues().cwiseMax(kSmallestInformation).cwiseInverse();
  const WantedMatrix scatter = V.transpose() * D * data.scatter * D * V;
  // In the axes of the model the sandwich is a matrix; its excess over the model on the diagonal inflates the axes, and
  // its correlations are kept by scaling.
  const WantedMatrix sandwich = variance.asDiagonal() * scatter * variance.asDiagonal();
  WantedVector inflation;
  for (int i = 0; i < kWanted; ++i) inflation[i] = std::max(1.0, sandwich(i, i) / variance[i]);
  return V * (variance.cwiseProduct(inflation)).asDiagonal() * V.transpose();
}

/// The largest other components of the weak directions that a vector lies along.
std::string companions(const WantedVector& vector, const std::vector<WeakDirection>& weak) {
  WantedVector along = WantedVector::Zero();
  for (const auto& w : weak) along += w.direction * w.direction.dot(vector);
  std::string text;
  for (int count = 0; count < 3; ++count) {
    int largest = 0;
    along.cwiseAbs().cwiseProduct((vector.array().abs() < 0.5).cast<double>().matrix()).maxCoeff(&largest);
    if (std::abs(along[largest]) < 0.2 || std::abs(vector[largest]) >= 0.5) break;
    text += (text.empty() ? "" : ", ") + parameterName(largest);
    along[largest] = 0;
  }
  return text;
}

/// @param vector unit vector in units of the prior; the parameter is `size` times its component
ParameterVerdict judge(const WantedVector& vector, double size, double limit, const WantedMatrix& held,
                       const WantedMatrix& whole, const std::vector<WeakDirection>& weak) {
  ParameterVerdict verdict;
  double share = 0;
  for (const auto& w : weak) share += std::pow(w.direction.dot(vector), 2);
  const bool known = std::sqrt(share) <= kMaxWeakShare;
  verdict.sigma = size * std::sqrt(vector.dot((known ? held : whole) * vector));
  verdict.verdict = !known ? Verdict::Unobservable : verdict.sigma <= limit ? Verdict::Observable : Verdict::Rough;
  if (known) return verdict;
  const std::string with = companions(vector, weak);
  verdict.why = with.empty() ? "the data say too little about it" : "cannot be told apart from " + with;
  return verdict;
}

}  // namespace

ParameterKind kindOf(int parameter) {
  if (parameter == kWanted - 1) return ParameterKind::SoundSpeed;
  const int own = parameter % kWantedSonarParameters;
  if (own == kTime) return ParameterKind::Time;
  return own < kRotX ? ParameterKind::Position : ParameterKind::Rotation;
}

double limitOf(int parameter, const CalibrationOptions& options) {
  switch (kindOf(parameter)) {
    case ParameterKind::Position:
      return options.positionLimit_m;
    case ParameterKind::Rotation:
      return options.rotationLimit_rad;
    case ParameterKind::Time:
      return options.timeLimit_s;
    case ParameterKind::SoundSpeed:
      break;
  }
  return options.soundSpeedLimit_mps;
}

double priorSigmaOf(int parameter, const CalibrationOptions& options) {
  switch (kindOf(parameter)) {
    case ParameterKind::Position:
      return options.positionSigma_m;
    case ParameterKind::Rotation:
      return options.rotationSigma_rad;
    case ParameterKind::Time:
      return options.timeSigma_s;
    case ParameterKind::SoundSpeed:
      break;
  }
  return options.soundSpeedSigma_mps;
}

std::string parameterName(int parameter) {
  static const char* const kNames[kWantedSonarParameters] = {
      "x", "y", "z", "turn about beam axis", "turn across plane", "turn in plane", "time offset"};
  if (parameter == kWanted - 1) return "sound speed";
  return std::string(sonarName(kSonars[static_cast<std::size_t>(parameter / kWantedSonarParameters)])) + " " +
         kNames[parameter % kWantedSonarParameters];
}

WantedVector correctionsOf(const CalibrationState& state) {
  WantedVector x;
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < kWantedSonarParameters; ++i)
      x[s * kWantedSonarParameters + i] =
          state.sonars[static_cast<std::size_t>(s)].correction[static_cast<std::size_t>(i)];
  x[kWanted - 1] = state.soundSpeed_mps - state.nominalSoundSpeed_mps;
  return x;
}

Observability assess(const DataInformation& data, const CalibrationOptions& options) {
  const WantedMatrix D = priors(options);
  WantedMatrix covariance = scaledCovariance(data, D);
  covariance(kWanted - 1, kWanted - 1) += std::pow(options.soundSpeedCommon_mps / options.soundSpeedSigma_mps, 2);
  const Eigen::SelfAdjointEigenSolver<WantedMatrix> eigen(covariance);
  Observability result;
  WantedMatrix held = WantedMatrix::Zero();
  for (int i = 0; i < kWanted; ++i) {
    const WantedVector v = eigen.eigenvectors().col(i);
    const double variance = eigen.eigenvalues()[i];
    if (variance > options.weakShare * options.weakShare)
      result.weak.push_back({v, std::sqrt(variance)});
    else
      held += variance * v * v.transpose();
  }
  result.covariance = D * held * D;
  for (int i = 0; i < kWanted; ++i)
    result.parameters.push_back(
        judge(WantedVector::Unit(i), priorSigmaOf(i, options), limitOf(i, options), held, covariance, result.weak));
  for (const int own : {kX, kY, kZ, kTime}) {
    const int h = own, v = own + kWantedSonarParameters;
    const WantedVector difference = (WantedVector::Unit(v) - WantedVector::Unit(h)) / std::sqrt(2.0);
    result.relative.push_back(judge(difference, std::sqrt(2.0) * priorSigmaOf(own, options), limitOf(own, options),
                                    held, covariance, result.weak));
  }
  return result;
}

}  // namespace s2s::calib
