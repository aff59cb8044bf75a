#include "ouster2rawlog/lidar_profile.h"

namespace s2s::tools::ouster {

namespace {

// Layouts of a pixel after Ouster's sensor manual, "Lidar Data Packet Format" and "Lidar Data Profiles".

/// 19-bit ranges with 5 flag bits and the reflectivity in the same word; the profiles with two returns use it twice.
LidarProfile::Echo wideEcho(unsigned word, PixelField signal) {
  return {{32 * word, 19}, {32 * word + 24, 8}, signal, {32 * word + 19, 5}};
}

/// 15-bit ranges in 8 mm.
LidarProfile::Echo narrowEcho(unsigned word) {
  return {{32 * word, 15, 3}, {32 * word + 16, 8}, {}, {32 * word + 15, 1}};
}

const LidarProfile::Echo kLegacyEcho{{0, 20}, {32, 8}, {48, 16}, {28, 4}};
const LidarProfile::Echo kSingleEcho{{0, 19}, {32, 8}, {48, 16}, {19, 5}};

const std::vector<LidarProfile>& profiles() {
  static const std::vector<LidarProfile> kProfiles{
      {"LEGACY", 12, {kLegacyEcho}, {64, 16}, ""},
      {"RNG19_RFL8_SIG16_NIR16", 12, {kSingleEcho}, {64, 16}, ""},
      {"RNG19_RFL8_SIG16_NIR16_DUAL", 16, {wideEcho(0, {64, 16}), wideEcho(1, {80, 16})}, {96, 16}, ""},
      {"RNG15_RFL8_NIR8", 4, {narrowEcho(0)}, {24, 8, 4}, ""},
      {"RNG15_RFL8_NIR8_DUAL", 8, {narrowEcho(0), narrowEcho(1)}, {24, 8, 4}, ""},
      {"FUSA_RNG15_RFL8_NIR8_DUAL", 8, {narrowEcho(0), narrowEcho(1)}, {24, 8, 4}, ""},
      {"FIVE_WORD_PIXEL", 20, {wideEcho(0, {64, 16}), wideEcho(1, {80, 16})}, {96, 16}, "fifth word"},
      {"RNG15_RFL8_WIN8", 4, {narrowEcho(0)}, {}, "window"},
      {"RNG15_RFL8_NIR8_ZONE16", 8, {narrowEcho(0)}, {24, 8, 4}, "zone mask, window"},
      {"RNG19_RFL8_SIG16_NIR16_ZONE16", 12, {kSingleEcho}, {64, 16}, "zone mask, window"},
      {"RNG19_RFL8_SIG16_ZONE16_DUAL", 16, {wideEcho(0, {64, 16}), wideEcho(1, {80, 16})}, {}, "zone mask, window"},
  };
  return kProfiles;
}

}  // namespace

const LidarProfile* findLidarProfile(const std::string& name) {
  for (const auto& profile : profiles())
    if (profile.name == name) return &profile;
  return nullptr;
}

std::vector<std::string> lidarProfileNames() {
  std::vector<std::string> names;
  for (const auto& profile : profiles()) names.push_back(profile.name);
  return names;
}

}  // namespace s2s::tools::ouster
