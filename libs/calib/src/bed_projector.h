#pragma once

#include <vector>

#include "bed_picture.h"
#include "s2s/calib/seabed_grid.h"
#include "s2s/calib/texture_residual.h"

namespace s2s::calib {

/// Lays pings of the horizontal sonar on the heights of the bed, by the mounting known by now.
class BedProjector {
 public:
  /// All must outlive the projector.
  BedProjector(const CalibrationState& state, const SeabedGrid& grid, const TextureOptions& options)
      : sonar_(ofTexture(state[SonarId::Horizontal])),
        soundSpeed_mps_(state.soundSpeed_mps),
        grid_(grid),
        options_(options) {}

  /// Appends a ping's samples, at elevations where the aperture's edges play no part.
  void project(const TexturePing& ping, const PingMotion& motion, std::vector<BedPicture::Sample>& samples) const;

  /// The beam by which a ping sees a place in the map; nothing outside the aperture and fan.
  std::optional<BedSight> sightOf(const Eigen::Vector3d& p_map, const Eigen::Vector2d& slope,
                                  const PingMotion& motion) const;

 private:
  static SonarState ofTexture(SonarState sonar) {
    sonar.correction = textureCorrection(sonar.correction.data());
    return sonar;
  }
  struct Anchor {
    bool done = false, valid = false;
    float x_m = 0, y_m = 0, elevation_rad = 0;
  };
  Eigen::Vector3d place(double bearing_rad, double range_m, double elevation_rad, const PingMotion& motion) const;
  Anchor meet(double bearing_rad, double range_m, const PingMotion& motion, double start_rad) const;
  double largestElevation() const { return options_.apertureShare * 0.5 * sonar_.aperture_rad; }

  SonarState sonar_;
  double soundSpeed_mps_;
  const SeabedGrid& grid_;
  const TextureOptions& options_;
};

}  // namespace s2s::calib
