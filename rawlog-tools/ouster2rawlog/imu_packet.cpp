#include "ouster2rawlog/imu_packet.h"

#include <cmath>
#include <cstring>

namespace s2s::tools::ouster {

namespace {

constexpr double kGravity_mps2 = 9.80665;  // the unit g in which the device counts
constexpr double kRadPerDeg = M_PI / 180.0;

constexpr std::size_t kLegacyBytes = 48;
constexpr std::size_t kHeaderBytes = 32, kNmeaBytes = 100, kReadingBytes = 36, kFooterBytes = 32;
constexpr std::size_t kFrameBytes = kHeaderBytes + kNmeaBytes + kFooterBytes;
constexpr std::size_t kMaxReadings = 64;

template <class T>
T load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

Eigen::Vector3d vectorAt(const std::uint8_t* bytes) {
  return {load<float>(bytes), load<float>(bytes + 4), load<float>(bytes + 8)};
}

ImuReading reading(std::uint64_t time_ns, const std::uint8_t* accelerationThenTurnRate) {
  return {time_ns, kGravity_mps2 * vectorAt(accelerationThenTurnRate),
          kRadPerDeg * vectorAt(accelerationThenTurnRate + 12)};
}

}  // namespace

bool isImuPacketSize(std::size_t bytes) {
  if (bytes == kLegacyBytes) return true;
  return bytes > kFrameBytes && (bytes - kFrameBytes) % kReadingBytes == 0 &&
         (bytes - kFrameBytes) / kReadingBytes <= kMaxReadings;
}

std::vector<ImuReading> parseImuPacket(const std::uint8_t* packet, std::size_t bytes) {
  // LEGACY: time of the system, the accelerometer and the gyroscope (u64 each), then six floats.
  if (bytes == kLegacyBytes) return {reading(load<std::uint64_t>(packet + 16), packet + 24)};
  std::vector<ImuReading> readings;
  for (std::size_t at = kHeaderBytes + kNmeaBytes; at + kReadingBytes + kFooterBytes <= bytes; at += kReadingBytes) {
    const bool valid = (load<std::uint16_t>(packet + at + 10) & 1) != 0;
    if (valid) readings.push_back(reading(load<std::uint64_t>(packet + at), packet + at + 12));
  }
  return readings;
}

}  // namespace s2s::tools::ouster
