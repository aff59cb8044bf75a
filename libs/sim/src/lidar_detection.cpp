#include <cmath>

#include "s2s/sim/lidar_effects.h"

namespace s2s::sim {

LidarEcho echoOf(const RayHit& hit, const Ray& ray, const Material& material) {
  const double cosIncidence = std::clamp<double>(-hit.normal.dot(ray.direction), 1e-3, 1.0);
  constexpr double kRetroBrightness = 20, kRetroLimit = 0.5;
  if (material.retro && cosIncidence > kRetroLimit) return {hit.range_m, kRetroBrightness, cosIncidence};
  return {hit.range_m, material.reflectivity * cosIncidence, cosIncidence};
}

void mixPixels(std::vector<LidarEcho>& column, double beamSpacing_rad, const LidarEffects& e, Random& random) {
  const double probability = std::min(1.0, e.beamDivergence_rad / beamSpacing_rad);
  for (std::size_t row = 0; row + 1 < column.size(); ++row) {
    LidarEcho& a = column[row];
    const LidarEcho& b = column[row + 1];
    if (!a.present() || !b.present()) continue;
    const double gap_m = std::abs(a.range_m - b.range_m);
    // Below a few centimetres, or on a surface that merely recedes, there is no edge.
    const double smooth_m = 0.1 + 3 * a.range_m * beamSpacing_rad / std::min(a.cosIncidence, b.cosIncidence);
    if (gap_m < smooth_m || gap_m > e.mixedMaxGap_m || random.uniform() > probability) continue;
    const double share = random.uniform();
    const double weightA = share * a.brightness, weightB = (1 - share) * b.brightness;
    a.range_m = (weightA * a.range_m + weightB * b.range_m) / (weightA + weightB);
    a.brightness = weightA + weightB;
  }
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
