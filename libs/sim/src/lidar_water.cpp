#include <cmath>

#include "s2s/sim/lidar_effects.h"

namespace s2s::sim {

double fresnelReflectance(double sineGrazing) {
  constexpr double kIndex = 1.33;
  const double cosIn = std::clamp(sineGrazing, 0.0, 1.0);  // the grazing angle's sine is the incidence's cosine
  const double sinOut = std::sqrt(1 - cosIn * cosIn) / kIndex, cosOut = std::sqrt(1 - sinOut * sinOut);
  const double s = (cosIn - kIndex * cosOut) / (cosIn + kIndex * cosOut);
  const double p = (cosOut - kIndex * cosIn) / (cosOut + kIndex * cosIn);
  return 0.5 * (s * s + p * p);
}

LidarEcho waterReturn(const Ray& ray, double rangeToWater_m, const LidarEffects& e, Random& random) {
  const double sineGrazing = -ray.direction.z();
  const double share = e.waterReturnShare * std::exp(-rangeToWater_m / e.waterReturnRange_m);
  if (random.uniform() >= share) return {};
  // A wave crest is met earlier, a trough later, by the height over the sine of the grazing angle.
  const double shift_m = e.waveHeightSigma_m * random.normal() / std::max(0.1, sineGrazing);
  return {std::max(0.1, rangeToWater_m - shift_m), 0.3, std::max(0.1, sineGrazing)};
}

MirroredRay mirrorAtWater(const Ray& ray, double rangeToWater_m, double maxRange_m) {
  MirroredRay mirrored;
  mirrored.ray.origin = ray.origin + static_cast<float>(rangeToWater_m) * ray.direction;
  mirrored.ray.direction = ray.direction.cwiseProduct(Eigen::Vector3f(1, 1, -1));
  mirrored.ray.maxRange_m = static_cast<float>(maxRange_m - rangeToWater_m);
  mirrored.reflectance = fresnelReflectance(-ray.direction.z());
  return mirrored;
}

}  // namespace s2s::sim
