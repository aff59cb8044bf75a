#include "s2s/products/report_page.h"

#include <cmath>
#include <cstdio>
#include <map>

#include "s2s/map/map_point.h"

namespace s2s::products {

namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0; background: #f4f6f8; color: #23272e; font: 16px/1.55 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
header { background: #14324a; color: #fff; padding: 2.2rem 1.5rem 2rem; }
header > div, main { max-width: 66rem; margin: 0 auto; }
header h1 { margin: 0 0 .3rem; font-size: 1.7rem; font-weight: 600; letter-spacing: .01em; }
header p { margin: 0; color: #c9d8e4; }
main { padding: 1.5rem; }
section { background: #fff; border: 1px solid #dfe4e9; border-radius: 6px; padding: 1.2rem 1.4rem; margin: 0 0 1.4rem; }
h2 { font-size: 1.15rem; margin: 0 0 .8rem; color: #14324a; }
h3 { font-size: 1rem; margin: 1.4rem 0 .3rem; }
.key { display: grid; grid-template-columns: repeat(auto-fit, minmax(9.5rem, 1fr)); gap: .8rem; padding: 0; margin: 0; }
.key div { background: #f4f7f9; border-radius: 4px; padding: .7rem .9rem; }
.key dt { font-size: .82rem; color: #5a6572; }
.key dd { margin: 0; font-size: 1.35rem; font-weight: 600; font-variant-numeric: tabular-nums; }
.key dd small { font-size: .8rem; font-weight: 400; color: #5a6572; }
table { border-collapse: collapse; width: 100%; font-size: .94rem; }
th, td { text-align: left; padding: .32rem .8rem .32rem 0; border-bottom: 1px solid #e7ebef; vertical-align: top; }
th { font-weight: 600; color: #5a6572; font-size: .85rem; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
figure { margin: 0 0 1.6rem; }
figure:last-child { margin-bottom: 0; }
figure img { display: block; width: 100%; height: auto; border: 1px solid #e7ebef; }
figcaption { font-size: .9rem; color: #4b5563; margin-top: .4rem; }
figcaption b { color: #23272e; }
ul { margin: 0; padding-left: 1.2rem; }
.warn { border-left: 4px solid #d39b22; }
.good { border-left: 4px solid #3b8f5a; }
pre { background: #f4f7f9; padding: .9rem; overflow-x: auto; font-size: .82rem; line-height: 1.45; border-radius: 4px; }
code { font-size: .92em; }
@media print { body { background: #fff; } section { break-inside: avoid; border: 0; padding: 0; } }
)css";

std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "&ndash;";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

/// 1234567 as "1 234 567" with narrow no-break spaces.
std::string grouped(std::uint64_t value) {
  const std::string digits = std::to_string(value);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += "&#8239;";
    out += digits[i];
  }
  return out;
}

std::string fileSize(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value < 1e3) return grouped(bytes) + " B";
  if (value < 1e6) return fixed(value / 1e3, 1) + " kB";
  return value < 1e9 ? fixed(value / 1e6, 1) + " MB" : fixed(value / 1e9, 2) + " GB";
}

std::string fact(const std::string& name, const std::string& value, const std::string& unit) {
  return "<div><dt>" + name + "</dt><dd>" + value + (unit.empty() ? "" : " <small>" + unit + "</small>") +
         "</dd></div>\n";
}

std::string row(const std::string& name, const std::string& value) {
  return "<tr><td>" + name + "</td><td class=\"n\">" + value + "</td></tr>\n";
}

std::string baseName(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

std::string head(const RunSummary& s) {
  std::string inputs;
  for (const auto& input : s.inputs) inputs += (inputs.empty() ? "" : ", ") + escape(baseName(input));
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Survey report " +
         inputs + "</title>\n<style>" + kStyle +
         "</style></head>\n<body>\n<header><div><h1>Seabed-to-sky survey report</h1>\n<p>" + inputs + " &middot; " +
         core::formatUtc(s.startTime) + " to " + core::formatUtc(s.endTime) + " &middot; " +
         core::formatDuration(s.duration_s) + "</p></div></header>\n<main>\n";
}

std::string picture(const ReportPicture& p) {
  return "<figure><img alt=\"" + escape(p.title) + "\" src=\"data:" + p.mediaType + ";base64," + toBase64(p.bytes) +
         "\">\n<figcaption><b>" + escape(p.title) + ".</b> " + escape(p.caption) + "</figcaption></figure>\n";
}

std::string keyFigures(const ReportContent& c) {
  const RunSummary& s = c.summary;
  std::uint64_t points = 0;
  for (const auto count : s.points) points += count;
  std::string out = "<section><h2>At a glance</h2>\n<dl class=\"key\">\n";
  out += fact("Path", fixed(s.pathLength_m, 1), "m");
  out += fact("Survey time", fixed(s.duration_s, 1), "s");
  out += fact("Map points", grouped(points), "");
  if (c.seabed.cells > 0) {
    out += fact("Seabed mapped", fixed(c.seabed.area_m2, 0), "m&sup2;");
    if (s.waterHeight_m)
      out += fact("Depths",
                  fixed(*s.waterHeight_m - c.seabed.maxHeight_m, 2) + " &ndash; " +
                      fixed(*s.waterHeight_m - c.seabed.minHeight_m, 2),
                  "m");
  }
  out += fact("Loop closures", grouped(s.loopClosures), "");
  out += fact("Speed of mapping", fixed(s.realtimeFactor(), 2), "&times; real time");
  return out + "</dl></section>\n";
}

std::string warnings(const RunSummary& s) {
  if (s.warnings.empty()) return "<section class=\"good\"><h2>Warnings and data faults</h2><p>None.</p></section>\n";
  std::string out = "<section class=\"warn\"><h2>Warnings and data faults</h2>\n<ul>\n";
  for (const auto& warning : s.warnings) out += "<li>" + escape(warning) + "</li>\n";
  return out + "</ul>\n</section>\n";
}

std::string pictures(const std::vector<ReportPicture>& all) {
  if (all.empty()) return "";
  std::string out = "<section><h2>The map</h2>\n";
  for (const auto& p : all) out += picture(p);
  return out + "</section>\n";
}

std::string latencies(const RunSummary& s) {
  if (s.latencies.empty()) return "";
  std::string out =
      "<h3>Latencies at the recorded rate</h3><table>\n<tr><th></th><th class=\"n\">count</th><th class=\"n\">median"
      "</th><th class=\"n\">95 %</th><th class=\"n\">largest</th></tr>\n";
  for (const auto& l : s.latencies) {
    out += "<tr><td>" + escape(l.name) + "</td><td class=\"n\">" + grouped(l.count) + "</td>";
    for (const double value_s : {l.median_s, l.p95_s, l.max_s})
      out += "<td class=\"n\">" + fixed(1000 * value_s, 1) + " ms</td>";
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

std::string numbers(const ReportContent& c) {
  const RunSummary& s = c.summary;
  std::string out = "<section><h2>Figures</h2>\n<h3>Data and solution</h3><table>\n";
  out += row("LiDAR sweeps", grouped(s.sweeps));
  out += row("Pings of the horizontal sonar", grouped(s.pingsHorizontal));
  out += row("Pings of the vertical sonar", grouped(s.pingsVertical));
  out += row("IMU samples", grouped(s.imuSamples));
  out += row("Keyframes", grouped(s.keyframes));
  out += row("Loop closures", grouped(s.loopClosures));
  std::string source = s.waterHeightSource.empty() ? "" : " (" + escape(s.waterHeightSource) + ")";
  out += row("Height of the water surface in the map frame" + source,
             s.waterHeight_m ? fixed(*s.waterHeight_m, 3) + " m" : "none known");
  if (s.priorMap)
    out += row("Place in the map " + escape(s.priorMap->folder),
               s.priorMap->located ? "found after " + fixed(s.priorMap->after_s, 1) + " s" : "not found");
  for (const auto& [name, value] : s.figures) out += row("<code>" + escape(name) + "</code>", fixed(value, 3));
  out += "</table>\n<h3>Points by layer</h3><table>\n";
  const std::array<const char*, 4> layers = {"LiDAR", "Sonar stereo: triangulated from both sonars",
                                             "Line-scan of the horizontal sonar", "Line-scan of the vertical sonar"};
  for (std::size_t i = 0; i < layers.size(); ++i) out += row(layers[i], grouped(s.points[i]));
  out += "</table>\n";
  if (c.seabed.soundings > 0) {
    out += "<h3>Seabed grid, " + fixed(c.gridCell_m, 2) + " m cells</h3><table>\n";
    out += row("Cells with a height", grouped(c.seabed.cells));
    out += row("Cells left empty: too few soundings", grouped(c.seabed.fewPoints));
    out += row("Cells left empty: nothing but wall", grouped(c.seabed.walls));
    out += row("Cells left empty: a step against all neighbours (hull, pile, fish)", grouped(c.seabed.steps));
    out += row("Soundings offered", grouped(c.seabed.soundings));
    out += row("Soundings not used: too near to the surface", grouped(c.seabed.tooShallow));
    out += "</table>\n";
  }
  out += "<h3>Run</h3><table>\n" + row("Wall time", fixed(s.wall_s, 1) + " s");
  for (const auto& [name, time] : s.stageTimes_s) out += row("&emsp;" + escape(name), fixed(time, 1) + " s");
  out += row("Peak memory", fixed(s.peakRss_mb, 0) + " MB");
  return out + "</table>\n" + latencies(s) + "</section>\n";
}

std::string gnss(const RunSummary& s) {
  if (!s.gnss) return "";
  const GnssSummary& g = *s.gnss;
  std::string out = std::string("<section") + (g.distrusted ? " class=\"warn\"" : "") + "><h2>GNSS, a guest</h2>\n<p>" +
                    (g.distrusted ? "GNSS contradicted the map and took no part in it."
                                  : "GNSS is believed only where it agrees with the map&rsquo;s own shape.") +
                    "</p>\n<table>\n";
  out += row("State", escape(g.state));
  out += row("Fixes compared with the map", grouped(g.fixes));
  out += row("of these in contradiction to it", grouped(g.unbelievable));
  out += row("Largest horizontal deviation", fixed(g.largestDeviation_m, 1) + " m");
  if (g.mapOrigin) {
    out += row("Origin of the map, WGS84",
               fixed(g.mapOrigin->latitude_deg, 6) + "&deg; " + fixed(g.mapOrigin->longitude_deg, 6) + "&deg;");
    out += row("Direction of its x axis, clockwise from north", fixed(g.mapOrigin->azimuth_deg, 2) + "&deg;");
  }
  out += "</table>\n";
  if (!g.spans.empty()) {
    out +=
        "<h3>When it contradicted the map</h3><table>\n<tr><th>from</th><th>to</th><th class=\"n\">fixes</th>"
        "<th class=\"n\">by up to</th></tr>\n";
    for (const auto& span : g.spans)
      out += "<tr><td>" + core::formatUtc(span.from) + "</td><td>" + core::formatUtc(span.to) +
             "</td><td class=\"n\">" + grouped(span.fixes) + "</td><td class=\"n\">" +
             fixed(span.largestDeviation_m, 1) + " m</td></tr>\n";
    out += "</table>\n";
  }
  return out + "</section>\n";
}

std::string files(const std::vector<ReportFile>& all) {
  static const std::map<std::string, const char*> kMeanings = {
      {"trajectory.tum", "optimised poses of the vehicle in the map, t x y z qx qy qz qw"},
      {"odometry.tum", "poses as the odometry had them, before loop closures"},
      {"keyframes.tum", "optimised poses of the keyframes"},
      {"trajectory.kitti", "optimised poses in KITTI form"},
      {"trajectory_times.txt", "times of the KITTI poses"},
      {"lidar.ply", "points above water"},
      {"stereo.ply", "points triangulated from both sonars"},
      {"line_horizontal.ply", "leading edges of the horizontal sonar"},
      {"line_vertical.ply", "leading edges of the vertical sonar"},
      {"map.ply", "all layers in one cloud"},
      {"map.las", "all layers, LAS 1.4; class 40 is the sonars', user data the layer"},
      {"seabed.tif", "seabed grid: height, standard deviation, soundings a cell"},
      {"seabed.bag", "seabed grid as Bathymetric Attributed Grid"},
      {"map.3Dscene", "for MRPT's SceneViewer3D"},
      {"map.simplemap", "for MRPT's map programs"},
      {"map.png", "the first picture above"}};
  std::string out =
      "<section><h2>Files</h2>\n<table><tr><th>file</th><th>what it is</th><th class=\"n\">size</th></tr>\n";
  for (const auto& file : all) {
    const auto meaning = kMeanings.find(file.name);
    out += "<tr><td><code>" + escape(file.name) + "</code></td><td>" +
           (meaning == kMeanings.end() ? "" : meaning->second) + "</td><td class=\"n\">" + fileSize(file.bytes) +
           "</td></tr>\n";
  }
  return out + "</table></section>\n";
}

constexpr const char* kMeaning = R"html(<section><h2>What the numbers mean</h2>
<p>All coordinates are metres in the <b>map frame</b>: z points up along gravity, the origin is the vehicle at the first
keyframe, x its direction there. The map is not georeferenced. Heights grow upwards; depths are counted down from the
water surface, whose height in the map frame is stated above.</p>
<p>Each point carries a <b>sigma</b>, the standard deviation of its position along its most uncertain axis. A line-scan
point knows range and bearing well and elevation only within the sonar's aperture, and its sigma says so.</p>
<p>A cell of the <b>seabed grid</b> holds the median of its soundings weighted by their precision. Where a cell spans more
than seabed, as beside a quay wall, only its lowest dense layer counts. The cell's sigma is that of a single ping: mostly the
scatter of the pings about the median, and, the fewer they are, what they claim of themselves. It is not divided by their number:
errors of pose and mounting are common to neighbouring pings and do not average out.</p>
<p>These figures come from the survey's own data. They are no comparison with independent control, and no IHO order is
claimed from them.</p></section>
)html";

}  // namespace

std::string reportPage(const ReportContent& content) {
  std::string out = head(content.summary);
  out += keyFigures(content);
  out += warnings(content.summary);
  out += pictures(content.pictures);
  out += numbers(content);
  out += gnss(content.summary);
  out += files(content.files);
  out += kMeaning;
  if (!content.summary.effectiveIni.empty())
    out += "<section><h2>Configuration used</h2><details><summary>Show all keys</summary>\n<pre>" +
           escape(content.summary.effectiveIni) + "</pre></details></section>\n";
  return out + "</main></body></html>\n";
}

std::string toBase64(const std::vector<unsigned char>& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t rest = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < rest ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= rest ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

}  // namespace s2s::products
