#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "s2s/core/time.h"

namespace s2s::products {

/// Where the map's origin lies and where its x axis points, WGS84.
struct GnssPlace {
  double latitude_deg = 0, longitude_deg = 0, height_m = 0;
  double azimuth_deg = 0;  ///< of the x axis, clockwise from north
};

/// What became of GNSS, the guest.
struct GnssSummary {
  struct Span {
    core::TimeNs from = 0, to = 0;
    std::uint64_t fixes = 0;
    double largestDeviation_m = 0;
  };
  std::string state;                   ///< "trusted", "distrusted", "too short to align", "absent" (switched off)
  bool distrusted = false;             ///< took no part in the map
  std::uint64_t fixes = 0;             ///< considered
  std::uint64_t unbelievable = 0;      ///< of these, in contradiction to the map
  double largestDeviation_m = 0;       ///< horizontal, from the aligned map
  std::vector<Span> spans;             ///< when it contradicted the map
  std::optional<GnssPlace> mapOrigin;  ///< while trusted

  /// True if there was track enough to compare it with the map.
  bool judged() const { return state == "trusted" || distrusted; }
};

/// Latency of a stage, or of a record through several, in a run at the recorded rate.
struct LatencySummary {
  std::string name;
  std::uint64_t count = 0;
  double median_s = 0, p95_s = 0, max_s = 0;
};

/// How a run found its place in a map made before.
struct PriorMapSummary {
  std::string folder;
  bool located = false;          ///< else the new map stands in a frame of its own
  double after_s = 0;            ///< from the first record until the place was found
  std::uint64_t registered = 0;  ///< keyframes registered against the old map after that
  std::uint64_t believed = 0;    ///< registrations that hold the new map in the old one's frame
};

/// What a mapping run was and what became of it: filled by the mapper, completed and written by `writeProducts`.
struct RunSummary {
  std::vector<std::string> inputs;  ///< rawlog files
  core::TimeNs startTime = 0;       ///< first and last record used
  core::TimeNs endTime = 0;
  double duration_s = 0;  ///< of the survey
  double wall_s = 0;      ///< of the run; writeProducts adds its own time
  double peakRss_mb = 0;  ///< writeProducts raises it to the process' peak when it is done

  std::uint64_t sweeps = 0;
  std::uint64_t pingsHorizontal = 0;
  std::uint64_t pingsVertical = 0;
  std::uint64_t imuSamples = 0;
  std::uint64_t keyframes = 0;
  std::uint64_t loopClosures = 0;
  double pathLength_m = 0;
  std::array<std::uint64_t, 4> points = {};  ///< by map::Layer; counted by writeProducts

  std::optional<double> waterHeight_m;  ///< height of the water surface in the map frame, when it is known
  std::string waterHeightSource;        ///< e.g. "configured", "estimated from the LiDAR"

  std::optional<PriorMapSummary> priorMap;  ///< nothing without one
  std::optional<GnssSummary> gnss;          ///< nothing without fixes

  std::vector<std::string> warnings;  ///< faults of the data among them, each kind once with its count
  std::vector<std::pair<std::string, double>> stageTimes_s;  ///< e.g. {"odometry", 41.2}
  std::vector<LatencySummary> latencies;                     ///< empty unless the run kept to the recorded rate
  /// Further figures for the table and `summary.json`; the name ends in its unit, e.g. {"loop_closure_residual_m",
  /// 0.02}.
  std::vector<std::pair<std::string, double>> figures;
  std::string effectiveIni;  ///< the configuration used, shown in the report

  double realtimeFactor() const { return wall_s > 0 ? duration_s / wall_s : 0; }
};

/// The summary as JSON with the keys of `share/docs/products.md`, indented, ending in a newline.
std::string toJson(const RunSummary& summary);

/// Reads the figures back out of a `summary.json`; what is absent keeps its default, `effectiveIni` is not in it.
/// @throws core::InputError with file and byte
RunSummary readSummary(const std::string& path);

}  // namespace s2s::products
