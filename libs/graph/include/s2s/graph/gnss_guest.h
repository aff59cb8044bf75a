#pragma once

#include <array>
#include <optional>
#include <vector>

#include "s2s/graph/keyframe.h"

namespace s2s::graph {

/// GNSS may help the map, never bend it: its fixes are compared with the map's own shape and believed only while both
/// agree.
struct GnssOptions {
  bool enabled = false;
  double minSigma_m = 0.5;    ///< receivers claim less than multipath in a harbour gives
  double minSpacing_m = 2.0;  ///< fixes nearer to the last used one than this are skipped
  double minTrack_m = 50.0;   ///< length of track before an alignment is tried
  int minFixes = 10;
  double driftPerMetre = 0.005;  ///< error of the map's own shape per metre from the track's middle, for the test
  double gate = 3.5;             ///< largest residual in standard deviations of a believed fix
  /// A run of so many unbelievable fixes in succession is no multipath but a lie: GNSS is then distrusted for the whole
  /// survey, and leaves the map.
  int distrustRun = 8;
  double distrustShare = 0.3;  ///< and so it is if this share of all fixes is unbelievable
  /// The error of a fix lasts (orbits, ionosphere, multipath of the same quay), so that all fixes of such a time count
  /// as one measurement: else hundreds of them would outweigh the map.
  double correlation_s = 120;
  double lossWidth = 2.0;  ///< width of the robust (Cauchy) loss in standard deviations
};

enum class GnssState {
  absent,     ///< no fixes, or switched off
  tooShort,   ///< too little track for an alignment
  trusted,    ///< in the graph
  distrusted  ///< contradicts the map; not in the graph
};
const char* gnssStateName(GnssState state);

/// A time in which GNSS contradicted the map.
struct GnssSpan {
  core::TimeNs from = 0, to = 0;  ///< first and last unbelievable fix
  int fixes = 0;                  ///< unbelievable ones
  double largestDeviation_m = 0;  ///< horizontal
};

struct GnssReport {
  GnssState state = GnssState::absent;
  int fixes = 0;                            ///< considered, after thinning
  int unbelievable = 0;                     ///< of these, beyond the gate
  int longestRun = 0;                       ///< of unbelievable fixes in succession
  double largestDeviation_m = 0;            ///< horizontal, of any fix from the aligned map
  core::TimeNs distrustedSince = 0;         ///< time of the first fix of the longest run, 0 if none
  std::vector<GnssSpan> spans;              ///< of more than single unbelievable fixes, in order of time
  std::optional<core::Isometry> T_enu_map;  ///< from the believable fixes, for georeferencing
};

/// A fix tied to the keyframe before it.
struct TiedFix {
  GnssFix fix;
  int keyframe = 0;
  Eigen::Vector3d p_keyframe_antenna = Eigen::Vector3d::Zero();
};

struct GnssAssessment {
  GnssReport report;
  std::vector<bool> believable;  ///< for each fix
};

/// Aligns the fixes with the map (yaw and translation, graduated non-convexity with a truncated loss, poses untouched)
/// and judges each.
GnssAssessment assessGnss(const std::vector<TiedFix>& fixes, const std::vector<Keyframe>& keyframes,
                          const GnssOptions& options);

}  // namespace s2s::graph
