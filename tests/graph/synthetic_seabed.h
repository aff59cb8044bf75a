#pragma once

#include <cmath>
#include <vector>

#include "fixed_random.h"
#include "s2s/graph/acoustic_submap.h"

namespace s2s::graph::test {

/// A seabed about 3 m below the map's origin: waves of random direction, 2 to 6 m long. The same seed gives the same.
class SyntheticSeabed {
 public:
  SyntheticSeabed(double amplitude_m, unsigned seed) {
    FixedRandom random(seed);
    for (int n = 0; n < 8; ++n) {
      const double direction = random.uniform(0, 2 * M_PI), length_m = random.uniform(2, 6);
      waves_.push_back({2 * M_PI / length_m * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                        random.uniform(0, 2 * M_PI), amplitude_m});
    }
  }
  /// Ripples of one direction and nothing else.
  static SyntheticSeabed ripples(double amplitude_m, double length_m) {
    SyntheticSeabed seabed(0, 0);
    seabed.waves_ = {{Eigen::Vector2d(2 * M_PI / length_m, 0), 0, amplitude_m}};
    return seabed;
  }

  double height_m(double x, double y) const {
    double z = -3;
    for (const Wave& wave : waves_)
      z += wave.amplitude_m * std::sin(wave.number.dot(Eigen::Vector2d(x, y)) + wave.phase);
    return z;
  }

  /// What is seen of the square of `width_m` below a vehicle: points with white noise of `sigma_m` in height.
  AcousticCloud seen(const core::Isometry& T_map_vehicle, double width_m, int count, double sigma_m,
                     FixedRandom& random) const {
    AcousticCloud points_vehicle;
    const core::Isometry T_vehicle_map = T_map_vehicle.inverse();
    for (int n = 0; n < count; ++n) {
      const double x = T_map_vehicle.translation().x() + random.uniform(-width_m / 2, width_m / 2);
      const double y = T_map_vehicle.translation().y() + random.uniform(-width_m / 2, width_m / 2);
      const Eigen::Vector3d p_map(x, y, height_m(x, y) + random.normal(sigma_m));
      points_vehicle.push_back(
          {(T_vehicle_map * p_map).cast<float>(), static_cast<float>(sigma_m), SharedErrors::Zero()});
    }
    return points_vehicle;
  }

 private:
  struct Wave {
    Eigen::Vector2d number;
    double phase, amplitude_m;
  };
  std::vector<Wave> waves_;
};

}  // namespace s2s::graph::test
