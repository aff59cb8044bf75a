#pragma once

#include <Eigen/Core>

#include "s2s/core/transform.h"
#include "s2s/sim/sonar_geometry.h"

namespace s2s::sim {

/// One indirect echo of a surface patch: where on the image and how strong against the direct one.
struct GhostEcho {
  double bearing_rad = 0;
  double range_m = 0;  ///< half the length of the whole way
  double gain = 0;     ///< power relative to the patch's direct echo on the imaging plane (pattern 1)
};

/// Echoes by way of the water surface, taken as a mirror at height 0 that loses `surfaceLoss_db` a bounce
/// (image method, e.g. Etter 2018, ch. 4): out direct and back over the surface, the same reversed, and both ways over
/// the surface. What the mirrored ways may be hidden by is not looked at: quays and hulls reach up to the surface.
class SurfaceMultipath {
 public:
  SurfaceMultipath(const SonarOptions& options, const SonarGeometry& geometry)
      : options_(options), geometry_(geometry) {}

  /// @param direct bearing and elevation of the patch in the sonar's frame
  /// @param ghosts three entries, gain 0 where there is none
  void find(const core::Isometry& T_world_sensor, const Eigen::Vector3d& p_world, const Eigen::Vector2d& direct,
            GhostEcho (&ghosts)[3]) const;

 private:
  const SonarOptions& options_;
  const SonarGeometry& geometry_;
};

}  // namespace s2s::sim
