#include "s2s/calib/sonar_parameters.h"

namespace s2s::calib {

const char* sonarName(SonarId id) { return id == SonarId::Horizontal ? "horizontal" : "vertical"; }

core::Isometry SonarState::corrected() const {
  core::Isometry T = T_vehicle_sonar;
  T.translation() += Eigen::Vector3d(correction[kX], correction[kY], correction[kZ]);
  T.linear() = T.linear() * core::expSo3({correction[kRotX], correction[kRotY], correction[kRotZ]});
  return T;
}

}  // namespace s2s::calib
