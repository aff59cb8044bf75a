#include "s2s/products/run_summary.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "s2s/core/error.h"
#include "s2s/map/map_point.h"

namespace s2s::products {

namespace {

using Json = nlohmann::ordered_json;

/// JSON knows no NaN and no infinity; both become null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Milliseconds are enough for durations; it keeps the file readable.
double milli(double value) { return std::isfinite(value) ? std::round(value * 1000) / 1000 : value; }

template <class Value>
void take(const Json& json, const char* key, Value& value) {
  if (json.contains(key) && !json[key].is_null()) value = json[key].get<Value>();
}

Json gnssJson(const GnssSummary& g) {
  Json json;
  json["state"] = g.state;
  json["distrusted"] = g.distrusted;
  json["fixes"] = g.fixes;
  json["unbelievable"] = g.unbelievable;
  json["largest_deviation_m"] = number(milli(g.largestDeviation_m));
  json["spans"] = Json::array();
  for (const auto& span : g.spans)
    json["spans"].push_back({{"from_utc", core::formatUtc(span.from)},
                             {"to_utc", core::formatUtc(span.to)},
                             {"from_time_ns", span.from},
                             {"to_time_ns", span.to},
                             {"fixes", span.fixes},
                             {"largest_deviation_m", number(milli(span.largestDeviation_m))}});
  json["map_origin"] = nullptr;
  if (g.mapOrigin)
    json["map_origin"] = {{"latitude_deg", g.mapOrigin->latitude_deg},
                          {"longitude_deg", g.mapOrigin->longitude_deg},
                          {"height_m", number(milli(g.mapOrigin->height_m))},
                          {"x_axis_azimuth_deg", number(milli(g.mapOrigin->azimuth_deg))}};
  return json;
}

GnssSummary gnssFromJson(const Json& json) {
  GnssSummary g;
  take(json, "state", g.state);
  take(json, "distrusted", g.distrusted);
  take(json, "fixes", g.fixes);
  take(json, "unbelievable", g.unbelievable);
  take(json, "largest_deviation_m", g.largestDeviation_m);
  if (json.contains("spans"))
    for (const auto& entry : json["spans"]) {
      GnssSummary::Span& span = g.spans.emplace_back();
      take(entry, "from_time_ns", span.from);
      take(entry, "to_time_ns", span.to);
      take(entry, "fixes", span.fixes);
      take(entry, "largest_deviation_m", span.largestDeviation_m);
    }
  if (json.contains("map_origin") && !json["map_origin"].is_null()) {
    GnssPlace& place = g.mapOrigin.emplace();
    take(json["map_origin"], "latitude_deg", place.latitude_deg);
    take(json["map_origin"], "longitude_deg", place.longitude_deg);
    take(json["map_origin"], "height_m", place.height_m);
    take(json["map_origin"], "x_axis_azimuth_deg", place.azimuth_deg);
  }
  return g;
}

RunSummary fromJson(const Json& json) {
  RunSummary s;
  take(json, "inputs", s.inputs);
  take(json, "start_time_ns", s.startTime);
  take(json, "end_time_ns", s.endTime);
  take(json, "duration_s", s.duration_s);
  take(json, "wall_s", s.wall_s);
  take(json, "peak_rss_mb", s.peakRss_mb);
  take(json, "sweeps", s.sweeps);
  take(json, "pings_horizontal", s.pingsHorizontal);
  take(json, "pings_vertical", s.pingsVertical);
  take(json, "imu_samples", s.imuSamples);
  take(json, "keyframes", s.keyframes);
  take(json, "loop_closures", s.loopClosures);
  take(json, "path_length_m", s.pathLength_m);
  for (const auto layer : map::kLayers)
    if (json.contains("points")) take(json["points"], map::layerName(layer), s.points[static_cast<std::size_t>(layer)]);
  if (json.contains("water_height_m") && !json["water_height_m"].is_null())
    s.waterHeight_m = json["water_height_m"].get<double>();
  take(json, "water_height_source", s.waterHeightSource);
  if (json.contains("gnss") && !json["gnss"].is_null()) s.gnss = gnssFromJson(json["gnss"]);
  if (json.contains("prior_map") && !json["prior_map"].is_null()) {
    PriorMapSummary& prior = s.priorMap.emplace();
    take(json["prior_map"], "folder", prior.folder);
    take(json["prior_map"], "located", prior.located);
    take(json["prior_map"], "after_s", prior.after_s);
    take(json["prior_map"], "registered", prior.registered);
    take(json["prior_map"], "believed", prior.believed);
  }
  take(json, "warnings", s.warnings);
  if (json.contains("stage_times_s"))
    for (const auto& [name, time] : json["stage_times_s"].items()) s.stageTimes_s.emplace_back(name, time);
  if (json.contains("latencies_s"))
    for (const auto& [name, entry] : json["latencies_s"].items()) {
      LatencySummary& latency = s.latencies.emplace_back();
      latency.name = name;
      take(entry, "count", latency.count);
      take(entry, "median", latency.median_s);
      take(entry, "p95", latency.p95_s);
      take(entry, "max", latency.max_s);
    }
  if (json.contains("figures"))
    for (const auto& [name, value] : json["figures"].items())
      s.figures.emplace_back(name, value.is_null() ? std::nan("") : value.get<double>());
  return s;
}

}  // namespace

std::string toJson(const RunSummary& s) {
  Json json;
  json["software"] = "Seabed-to-Sky " S2S_VERSION;
  json["inputs"] = s.inputs;
  json["start_utc"] = core::formatUtc(s.startTime);
  json["end_utc"] = core::formatUtc(s.endTime);
  json["start_time_ns"] = s.startTime;
  json["end_time_ns"] = s.endTime;
  json["duration_s"] = number(milli(s.duration_s));
  json["wall_s"] = number(milli(s.wall_s));
  json["realtime_factor"] = number(milli(s.realtimeFactor()));
  json["peak_rss_mb"] = number(milli(s.peakRss_mb));
  json["sweeps"] = s.sweeps;
  json["pings_horizontal"] = s.pingsHorizontal;
  json["pings_vertical"] = s.pingsVertical;
  json["imu_samples"] = s.imuSamples;
  json["keyframes"] = s.keyframes;
  json["loop_closures"] = s.loopClosures;
  json["path_length_m"] = number(milli(s.pathLength_m));
  for (const auto layer : map::kLayers)
    json["points"][map::layerName(layer)] = s.points[static_cast<std::size_t>(layer)];
  json["water_height_m"] = s.waterHeight_m ? number(*s.waterHeight_m) : Json(nullptr);
  json["water_height_source"] = s.waterHeightSource;
  json["gnss"] = s.gnss ? gnssJson(*s.gnss) : Json(nullptr);
  json["prior_map"] = nullptr;
  if (s.priorMap)
    json["prior_map"] = {{"folder", s.priorMap->folder},
                         {"located", s.priorMap->located},
                         {"after_s", number(milli(s.priorMap->after_s))},
                         {"registered", s.priorMap->registered},
                         {"believed", s.priorMap->believed}};
  json["figures"] = Json::object();
  for (const auto& [name, value] : s.figures) json["figures"][name] = number(value);
  json["stage_times_s"] = Json::object();
  for (const auto& [name, time] : s.stageTimes_s) json["stage_times_s"][name] = number(milli(time));
  json["latencies_s"] = Json::object();
  for (const auto& l : s.latencies)
    json["latencies_s"][l.name] = {
        {"count", l.count}, {"median", number(l.median_s)}, {"p95", number(l.p95_s)}, {"max", number(l.max_s)}};
  json["warnings"] = s.warnings;
  // Names come from files and may hold anything; broken UTF-8 is replaced instead of refused.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunSummary readSummary(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw core::InputError("cannot open the summary", path, "give the output folder of a mapping run");
  try {
    return fromJson(Json::parse(file));
  } catch (const nlohmann::json::parse_error& error) {
    throw core::InputError("the summary is no valid JSON", path + " byte " + std::to_string(error.byte),
                           "make the map again");
  } catch (const nlohmann::json::exception& error) {
    throw core::InputError(std::string("the summary holds a value of the wrong kind: ") + error.what(), path,
                           "make the map again");
  }
}

}  // namespace s2s::products
