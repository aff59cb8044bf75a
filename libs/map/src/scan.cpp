#include "s2s/map/scan.h"

#include <algorithm>
#include <cmath>

#include "s2s/sonar/ping_geometry.h"

namespace s2s::map {

namespace {

constexpr float kLargestHalf = 65504.0f;
constexpr double kSmallestSigma_m = 1e-3;
constexpr double kSigmaStep = 1.04;  // 1 mm * 1.04^255 = 22 m

}  // namespace

Eigen::Vector3d pointOf(const PackedReturn& packed, obs::BearingModel model) {
  return sonar::pointAt({packed.range_m, packed.bearing_rad, kElevationStep_rad * packed.elevation}, model);
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

StoredLineScan toStored(const ScanPose& pose, const LineScan& scan) {
  StoredLineScan stored;
  stored.pose = pose;
  stored.T_vehicle_sonar = scan.T_vehicle_sonar;
  stored.verticalAperture_rad = static_cast<float>(scan.verticalAperture_rad);
  stored.bearingSigma_rad = static_cast<float>(scan.bearingSigma_rad);
  stored.bearingModel = scan.bearingModel;
  stored.returns.reserve(scan.returns.size());
  for (const LineReturn& r : scan.returns) {
    if (!std::isfinite(r.range_m) || !std::isfinite(r.bearing_rad) || r.range_m <= 0) continue;
    PackedReturn packed;
    packed.range_m = r.range_m;
    packed.bearing_rad = r.bearing_rad;
    packed.intensityHalf = toHalf(r.intensity);
    packed.rangeSigmaCode = encodeSigma(r.sigma_m);
    packed.order = std::min(r.order, kMaxOrder) & kMaxOrder;
    packed.isRidge = r.isRidge ? 1 : 0;
    stored.returns.push_back(packed);
  }
  return stored;
}

}  // namespace s2s::map
