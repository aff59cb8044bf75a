#include "s2s/map/scan.h"

#include <algorithm>
#include <cmath>

namespace s2s::map {

namespace {

constexpr float kLargestHalf = 65504.0f;
constexpr double kSmallestSigma_m = 1e-3;
constexpr double kSigmaStep = 1.04;  // 1 mm * 1.04^255 = 22 m

}  // namespace

Eigen::Vector3d arcPoint(obs::BearingModel model, double range_m, double bearing_rad, double elevation_rad) {
  const double ce = std::cos(elevation_rad), se = std::sin(elevation_rad);
  const double cb = std::cos(bearing_rad), sb = std::sin(bearing_rad);
  if (model == obs::BearingModel::Azimuth) return range_m * Eigen::Vector3d(ce * cb, ce * sb, se);
  const double z = std::clamp(se, -std::abs(cb), std::abs(cb));
  return range_m * Eigen::Vector3d(std::sqrt(std::max(0.0, cb * cb - z * z)), sb, z);
}

std::uint16_t toHalf(float value) {
  return Eigen::numext::bit_cast<std::uint16_t>(Eigen::half(std::clamp(value, -kLargestHalf, kLargestHalf)));
}

float fromHalf(std::uint16_t half) { return static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(half)); }

PackedPoint pack(const ScanPoint& point) {
  return {point.p_vehicle.x(), point.p_vehicle.y(), point.p_vehicle.z(), toHalf(point.intensity),
          toHalf(point.sigma_m)};
}

ScanPoint unpack(const PackedPoint& packed) {
  return {{packed.x, packed.y, packed.z}, fromHalf(packed.intensityHalf), fromHalf(packed.sigmaHalf)};
}

std::uint8_t encodeSigma(double sigma_m) {
  if (!(sigma_m > kSmallestSigma_m)) return 0;
  // The small allowance lets a decoded sigma encode to itself again.
  const double steps = std::ceil(std::log(sigma_m / kSmallestSigma_m) / std::log(kSigmaStep) - 1e-6);
  return static_cast<std::uint8_t>(std::min(255.0, steps));
}

double decodeSigma(std::uint8_t code) { return kSmallestSigma_m * std::pow(kSigmaStep, code); }

}  // namespace s2s::map
