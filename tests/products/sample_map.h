#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "s2s/products/point_source.h"
#include "s2s/products/write_products.h"

namespace s2s::products {

/// A small made-up canal for tests: length x 20 m, quay walls at both sides from the bed to 2 m above the water, a bed
/// that slopes from 3 m to 4 m depth, trees and houses behind the quay. The vehicle goes once along the middle.
struct SampleMap {
  double length_m = 60;
  std::uint32_t seed = 1;
  int lidarPoints = 60'000;
  int sonarPoints = 20'000;
  core::TimeNs start = 1'733'400'000'000'000'000;

  double bedHeight(double x) const { return -3 - x / length_m; }

  Trajectories trajectories() const {
    Trajectories t;
    for (int i = 0; i <= 10 * static_cast<int>(length_m); ++i) {
      const double x = 0.1 * i;
      const auto T = core::isometryFromXyzYpr(x, std::sin(0.1 * x), 0.02 * std::sin(x), 0.1 * std::cos(0.1 * x), 0, 0);
      t.optimised.append(timeAt(x), T);
      t.odometry.append(timeAt(x), core::isometryFromXyzYpr(0.01 * x, 0, 0, 0, 0, 0) * T);
      if (i % 10 == 0) t.keyframes.append(timeAt(x), T);
    }
    return t;
  }

  core::TimeNs timeAt(double x) const { return start + core::durationNs(x); }  // 1 m/s

  PointSource source() const {
    return [map = *this](s2s::map::Layer layer, const PointVisitor& visit) { map.forEach(layer, visit); };
  }

 private:
  void forEach(s2s::map::Layer layer, const PointVisitor& visit) const {
    std::mt19937 random(seed + static_cast<std::uint32_t>(layer));
    std::uniform_real_distribution<double> unit(0, 1);
    std::normal_distribution<double> noise(0, 0.02);
    const bool lidar = layer == s2s::map::Layer::Lidar;
    for (int i = 0; i < (lidar ? lidarPoints : sonarPoints); ++i) {
      s2s::map::MapPoint p;
      p.layer = layer;
      const double x = length_m * unit(random);
      p.time = timeAt(x);
      p.intensity = static_cast<float>(255 * unit(random));
      p.sigma_m = lidar ? 0.02F : 0.06F;
      const double side = unit(random) < 0.5 ? -1 : 1, u = unit(random);
      if (lidar)
        p.p_map = u < 0.5 ? Eigen::Vector3d(x, 10 * side, 2 * unit(random))
                          : Eigen::Vector3d(x, side * (10 + 12 * unit(random)), 2 + std::pow(unit(random), 4) * 8);
      else
        p.p_map = u < 0.8 ? Eigen::Vector3d(x, -10 + 20 * unit(random), bedHeight(x))
                          : Eigen::Vector3d(x, 10 * side, bedHeight(x) * unit(random));
      p.p_map += Eigen::Vector3d(noise(random), noise(random), noise(random));
      visit(p);
    }
  }
};

}  // namespace s2s::products
