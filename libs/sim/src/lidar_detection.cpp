#include <cmath>

#include "s2s/sim/lidar_effects.h"

namespace s2s::sim {

LidarEcho echoOf(const RayHit& hit, const Ray& ray, const Material& material) {
  const double cosIncidence = std::clamp<double>(-hit.normal.dot(ray.direction), 1e-3, 1.0);
  constexpr double kRetroBrightness = 20, kRetroLimit = 0.5;
  if (material.retro && cosIncidence > kRetroLimit) return {hit.range_m, kRetroBrightness, cosIncidence};
  return {hit.range_m, material.reflectivity * cosIncidence, cosIncidence};
}

namespace {

double besideAngle_rad(const LidarEffects& e) { return M_PI * 0.5 * e.beamDivergence_rad; }

}  // namespace

Eigen::Vector3f directionBeside(const Eigen::Vector3f& direction, const LidarEffects& e, Random& random) {
  const Eigen::Vector3f across = direction.unitOrthogonal(), other = direction.cross(across);
  const auto side = static_cast<float>(random.uniform(0, 2 * M_PI));
  const auto angle = static_cast<float>(besideAngle_rad(e));
  return std::cos(angle) * direction + std::sin(angle) * (std::cos(side) * across + std::sin(side) * other);
}

void mixPixel(LidarEcho& echo, const LidarEcho& beside, const LidarEffects& e, Random& random) {
  if (!echo.present() || !beside.present()) return;
  const double gap_m = std::abs(echo.range_m - beside.range_m);
  // Below a few centimetres, or on a surface that merely recedes, there is no edge.
  const double smooth_m =
      0.1 + 3 * echo.range_m * besideAngle_rad(e) / std::min(echo.cosIncidence, beside.cosIncidence);
  if (gap_m < smooth_m || gap_m > e.mixedMaxGap_m) return;
  // The beam's middle is on its own surface, so more than half of the footprint is.
  const double share = random.uniform(0.5, 1.0);
  const double own = share * echo.brightness, other = (1 - share) * beside.brightness;
  echo.range_m = (own * echo.range_m + other * beside.range_m) / (own + other);
  echo.brightness = own + other;
}

double detectedRange_m(const LidarEcho& echo, const LidarEffects& e, Random& random) {
  if (!echo.present()) return 0;
  double range_m = echo.range_m;
  if (e.dropouts) {
    // The signal falls with the square of the range; a white surface at the nominal range is lost every other time.
    const double ratio = e.halfRange_m / range_m;
    if (random.uniform() < std::pow(0.5, echo.brightness * ratio * ratio)) return 0;
  }
  const double tangent = std::sqrt(1 / (echo.cosIncidence * echo.cosIncidence) - 1);
  if (e.bias) {
    const double dark = std::max(0.0, 1 - echo.brightness);
    range_m += std::min(10.0, 1 / echo.cosIncidence - 1) * e.incidenceBias_m + dark * e.darkBias_m;
  }
  if (e.noise) {
    const double stretch_m = 0.1 * echo.range_m * e.beamDivergence_rad * std::min(tangent, 5.0);
    const double sigma_m = e.rangeSigma_m + e.rangeSigmaFar_mPerM * echo.range_m;
    range_m += std::hypot(sigma_m, stretch_m) * random.normal();
  }
  return range_m;
}

}  // namespace s2s::sim
