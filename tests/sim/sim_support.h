#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "s2s/sim/ray_caster.h"
#include "s2s/sim/shapes.h"
#include "s2s/sim/sonar_echo.h"

namespace s2s::test {

/// A scene of given meshes, all of one material with a Lambert coefficient of -20 dB and reflectivity 0.5.
inline sim::Scene sceneOf(const std::vector<sim::TriangleMesh>& meshes) {
  sim::Scene scene;
  scene.name = "test";
  sim::Material material;
  material.name = "grey";
  material.backscatter_db = -20;
  material.reflectivity = 0.5;
  scene.materials.push_back(material);
  for (const auto& mesh : meshes)
    scene.objects.push_back({"object" + std::to_string(scene.objects.size()), sim::ObjectKind::Object, 0, mesh});
  return scene;
}

/// A horizontal square of the given half side around (0, 0) at height z.
inline sim::TriangleMesh makeFloor(double z, double half_m) {
  sim::TriangleMesh mesh;
  const auto a = mesh.addVertex({-half_m, -half_m, z}), b = mesh.addVertex({half_m, -half_m, z}),
             c = mesh.addVertex({half_m, half_m, z}), d = mesh.addVertex({-half_m, half_m, z});
  mesh.addQuad(a, b, c, d);
  return mesh;
}

inline sim::TriangleMesh moved(sim::TriangleMesh mesh, double x, double y, double z, double yaw = 0, double pitch = 0) {
  mesh.transform(core::isometryFromXyzYpr(x, y, z, yaw, pitch, 0));
  return mesh;
}

/// The textbook's sonar: a wedge with sharp edges, no noise and no artefacts.
inline sim::SonarOptions idealSonar() {
  sim::SonarOptions o;
  o.elevationPattern = sim::ElevationPattern::Rectangle;
  o.multipath = o.volume = o.texture = o.noise = o.speckle = o.absorption = false;
  o.artefacts.rowLeak = o.artefacts.ringDown = o.artefacts.banding = o.artefacts.streaks = false;
  o.artefacts.centreHaze = o.artefacts.crossTalk = false;
  return o;
}

/// What the ideal sonar receives at a pose in a scene.
inline sim::EchoImage traceEcho(const sim::SonarOptions& options, const sim::Scene& scene,
                                const core::Isometry& T_world_sensor,
                                std::vector<sim::StrongReturn>* strongest = nullptr) {
  const sim::SonarGeometry geometry(options);
  const sim::RayCaster caster(scene.objects);
  const sim::EchoTracer tracer(options, geometry, scene, caster);
  sim::EchoImage image;
  sim::Random random(5);
  tracer.trace(T_world_sensor, random, image, strongest);
  return image;
}

/// First and last range bin of a beam with power; -1 if there is none.
inline std::pair<int, int> extent(const sim::EchoImage& image, std::size_t beam) {
  std::pair<int, int> bins(-1, -1);
  for (std::size_t bin = 0; bin < image.rangeCount; ++bin)
    if (image.at(bin, beam) > 0) {
      if (bins.first < 0) bins.first = static_cast<int>(bin);
      bins.second = static_cast<int>(bin);
    }
  return bins;
}

/// Largest distance between the empirical distribution of the samples and `cdf` (Kolmogorov and Smirnov).
inline double kolmogorovDistance(std::vector<double> samples, const std::function<double(double)>& cdf) {
  std::sort(samples.begin(), samples.end());
  const auto n = static_cast<double>(samples.size());
  double distance = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double f = cdf(samples[i]);
    distance = std::max({distance, f - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - f});
  }
  return distance;
}

/// Distance that samples of the true distribution stay below with a probability of 99 %.
inline double kolmogorovLimit(std::size_t n) { return 1.628 / std::sqrt(static_cast<double>(n)); }

}  // namespace s2s::test
