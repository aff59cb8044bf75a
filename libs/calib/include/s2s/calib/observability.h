#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "s2s/calib/options.h"
#include "s2s/calib/sonar_parameters.h"

namespace s2s::calib {

/// The wanted parameters in one vector: those of the horizontal sonar, of the vertical one, and the sound speed.
constexpr int kWanted = 2 * kWantedSonarParameters + 1;
using WantedVector = Eigen::Matrix<double, kWanted, 1>;
using WantedMatrix = Eigen::Matrix<double, kWanted, kWanted>;

enum class ParameterKind { Position, Rotation, Time, SoundSpeed };
ParameterKind kindOf(int parameter);
/// The limit of the verdict, in the parameter's own unit.
double limitOf(int parameter, const CalibrationOptions& options);
/// How well a parameter is known beforehand.
double priorSigmaOf(int parameter, const CalibrationOptions& options);
/// E.g. "horizontal x".
std::string parameterName(int parameter);
WantedVector correctionsOf(const CalibrationState& state);

/// What the data say about the wanted parameters, seabed and nuisances marginalised.
struct DataInformation {
  WantedMatrix information = WantedMatrix::Zero();  ///< if the noise were independent
  WantedMatrix scatter = WantedMatrix::Zero();      ///< sum over blocks of time of g g^T, g = that block's gradient
};

/// A combination of parameters that the data cannot tell. Components in units of what is known beforehand, norm 1.
struct WeakDirection {
  WantedVector direction = WantedVector::Zero();
  double sigma = 0;  ///< along it, in the same units
};

enum class Verdict { Observable, Rough, Unobservable };

struct ParameterVerdict {
  Verdict verdict = Verdict::Unobservable;
  double sigma = 0;  ///< [m], [rad], [s] or [m/s]
  std::string why;   ///< it is not observable; else empty
};

struct Observability {
  std::vector<WeakDirection> weak;
  std::vector<ParameterVerdict> parameters;  ///< kWanted
  /// The vertical sonar's less the horizontal one's, for x, y, z and time: can be known where neither is.
  std::vector<ParameterVerdict> relative;
  WantedMatrix covariance = WantedMatrix::Zero();  ///< with the weak directions held
};

/// Splits the parameter space into what the data tell and what they do not.
///
/// Covariance: the larger, along each direction, of the inverse information and of the sandwich A^-1 (sum g g^T) A^-1,
/// which stays honest when errors of neighbouring echoes and pings are alike. Scaled by what is known beforehand, its
/// eigenvectors with a standard deviation above `weakShare` are weak, and stay nominal. A parameter of which more than
/// a little lies along those is not observable; any other is observable if known within its limit, else a rough
/// estimate.
Observability assess(const DataInformation& data, const CalibrationOptions& options);

}  // namespace s2s::calib
