#include "closing_table.h"

#include <mrpt/core/format.h>

#include "s2s/core/error.h"
#include "s2s/core/time.h"
#include "s2s/map/map_point.h"

namespace s2s::apps {

namespace {

std::string row(const std::string& name, const std::string& value) {
  return mrpt::format("  %-24s %s\n", name.c_str(), value.c_str());
}

std::string count(std::uint64_t n) { return std::to_string(n); }

std::string gnssText(const products::GnssSummary& g) {
  if (!g.judged()) return g.state + " (" + count(g.fixes) + " fixes)";
  return g.state + ", " + count(g.fixes - g.unbelievable) + " of " + count(g.fixes) + " fixes agree with the map";
}

}  // namespace

void requireMapArguments(const mapper::SurveyRun& run, const std::string& config) {
  if (run.rawlog.empty())
    throw core::ConfigError("no rawlog was given", "command line",
                            "seabed-sky-map SURVEY.rawlog --config INI --output DIR");
  if (config.empty())
    throw core::ConfigError("no configuration was given", "command line",
                            "add --config INI; ini/ has one for each purpose, a simulated survey brings its own");
  if (run.output.empty()) throw core::ConfigError("no output folder was given", "command line", "add --output DIR");
}

std::string closingTable(const products::RunSummary& s, const std::string& output) {
  std::string text = "\nMap of " + (s.inputs.empty() ? std::string("the survey") : s.inputs.front()) + "\n";
  text += row("start", core::formatUtc(s.startTime));
  text += row("duration", core::formatDuration(s.duration_s));
  text += row("processing", core::formatDuration(s.wall_s) + mrpt::format(" (%.2f x real time)", s.realtimeFactor()));
  text += row("path", mrpt::format("%.1f m", s.pathLength_m));
  text += row("LiDAR sweeps", count(s.sweeps));
  text += row("IMU samples", count(s.imuSamples));
  text += row("pings", count(s.pingsHorizontal) + " horizontal, " + count(s.pingsVertical) + " vertical");
  text += row("keyframes", count(s.keyframes));
  text += row("loop closures", count(s.loopClosures));
  if (s.priorMap)
    text += row("place in the prior map", s.priorMap->located
                                              ? mrpt::format("found after %.1f s, held by %s registrations",
                                                             s.priorMap->after_s, count(s.priorMap->believed).c_str())
                                              : "not found");
  if (s.gnss) text += row("GNSS", gnssText(*s.gnss));
  for (const auto layer : map::kLayers)
    text += row(std::string("points ") + map::layerName(layer), count(s.points[static_cast<std::size_t>(layer)]));
  if (s.waterHeight_m) text += row("water height in the map", mrpt::format("%.3f m", *s.waterHeight_m));
  text += row("peak memory", mrpt::format("%.0f MB", s.peakRss_mb));
  text += row("products", output);
  if (!s.latencies.empty())
    text += mrpt::format("%-44s %8s %10s %10s %10s\n", "Latencies at the recorded rate", "count", "median", "95 %",
                         "largest");
  for (const auto& l : s.latencies)
    text += mrpt::format("  %-42s %8s %7.1f ms %7.1f ms %7.1f ms\n", l.name.c_str(), count(l.count).c_str(),
                         1e3 * l.median_s, 1e3 * l.p95_s, 1e3 * l.max_s);
  if (!s.warnings.empty()) text += "Warnings\n";
  for (const auto& warning : s.warnings) text += "  - " + warning + "\n";
  return text;
}

}  // namespace s2s::apps
