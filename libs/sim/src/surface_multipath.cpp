#include "s2s/sim/surface_multipath.h"

#include <cmath>

#include "s2s/sim/elevation_pattern.h"

namespace s2s::sim {

using Eigen::Vector3d;

void SurfaceMultipath::find(const core::Isometry& T_world_sensor, const Vector3d& p_world,
                            const Eigen::Vector2d& direct, GhostEcho (&ghosts)[3]) const {
  const Vector3d mirrored_world(p_world.x(), p_world.y(), -p_world.z());  // the patch as seen in the surface
  const Vector3d p_sensor = T_world_sensor.inverse() * mirrored_world;
  const double r1 = (p_world - T_world_sensor.translation()).norm(), r2 = p_sensor.norm();
  const Eigen::Vector2d over = geometry_.bearingElevation(p_sensor / r2);
  const bool behind = std::abs(over.x()) > 0.5 * M_PI;  // the back of the transducer is baffled
  const double gainDirect = elevationPattern(options_, direct.y());
  const double gainOver = behind ? 0 : elevationPattern(options_, over.y());
  const double bounce = std::pow(10, -0.1 * options_.surfaceLoss_db) * (r1 * r1) / (r2 * r2);
  const double absorbed = options_.absorption ? std::pow(10, -0.1 * options_.absorption_dbPerM * (r2 - r1)) : 1;
  const double once = gainDirect * gainOver * bounce * absorbed;
  ghosts[0] = {over.x(), 0.5 * (r1 + r2), once};
  ghosts[1] = {direct.x(), 0.5 * (r1 + r2), once};
  ghosts[2] = {over.x(), r2, gainOver * gainOver * bounce * bounce * absorbed * absorbed};
}

}  // namespace s2s::sim
