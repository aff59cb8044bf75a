#include <cstdio>

#include "command_line.h"
#include "s2s/core/atomic_file.h"
#include "s2s/core/ini_file.h"
#include "s2s/eval/statistics.h"
#include "stereo_truth.h"

namespace {

using namespace s2s;

sonar::SonarOptions paperLiteral() {
  sonar::SonarOptions options;
  options.horizontal.features.maxRunWidth_rad = options.vertical.features.maxRunWidth_rad = 0;
  options.horizontal.preprocess.normaliseQuantile = options.vertical.preprocess.normaliseQuantile = 1;
  options.stereo.clusters.cost = sonar::ClusterCost::Literal;
  options.stereo.clusters.maxGap_m = 1e3;
  options.stereo.matching.cost = sonar::FeatureCost::Literal;
  options.stereo.triangulation.fusion = sonar::Fusion::Average;
  options.stereo.matching.apertureMargin_rad = M_PI;
  return options;
}

void printRow(const char* name, const bench::StereoScore& s) {
  const auto d = eval::summarise(s.distances_m);
  const auto share = [](std::size_t part, std::size_t whole) { return whole ? 100.0 * part / whole : 0.0; };
  std::printf(
      "%-22s %6.1f pts/pair  median %.3f  mean %.3f  95%% %.3f m  within 2 sigma %4.1f %%  correct matches %4.1f %%  "
      "patches found %4.1f %%  %.2f ms/pair\n",
      name, static_cast<double>(d.count) / std::max<std::size_t>(1, s.pairs), d.median, d.mean, d.p95,
      100 * eval::shareWithin(s.normalised, 2.0), share(s.correct, s.matches), share(s.found, s.patches),
      1e3 * s.seconds / std::max<std::size_t>(1, s.pairs));
}

void writePoints(const std::string& path, const bench::StereoScore& s) {
  std::string text =
      "x_world,y_world,z_world,x_h,y_h,z_h,distance,above,sigma,residual,intensity,bin_h,beam_h,bin_v,beam_v\n";
  for (const auto& p : s.points) {
    for (const double value : {p.p_world.x(), p.p_world.y(), p.p_world.z(), p.stereo.p_h.x(), p.stereo.p_h.y(),
                               p.stereo.p_h.z(), p.distance_m, p.aboveTop_m, p.stereo.sigma_m(), p.stereo.residual})
      text += core::printDouble(value) + ",";
    text += std::to_string(p.stereo.intensity) + "," + std::to_string(p.stereo.bin_h) + "," +
            std::to_string(p.stereo.beam_h) + "," + std::to_string(p.stereo.bin_v) + "," +
            std::to_string(p.stereo.beam_v) + "\n";
  }
  core::writeTextFile(path, text);
}

void writeMatches(const std::string& path, const bench::StereoScore& s) {
  std::string text = "pair,range_h,bearing_h,range_v,bearing_v,intensity_h,intensity_v,cost,spread,gap\n";
  for (const auto& m : s.judged) {
    text += std::to_string(m.pair);
    for (const double value :
         {m.h.range_m, m.h.bearing_rad, m.v.range_m, m.v.bearing_rad, static_cast<double>(m.h.intensity),
          static_cast<double>(m.v.intensity), m.match.cost, m.match.spread_m, m.gap_m})
      text += "," + core::printDouble(value);
    text += "\n";
  }
  core::writeTextFile(path, text);
}

struct Outputs {
  std::string points, matches;
};

int measure(const std::string& folder, const std::string& config, const Outputs& outputs, std::size_t stride,
            bool all) {
  sonar::SonarOptions options;
  if (!config.empty()) {
    auto ini = core::IniFile::load(config);
    sonar::loadSonars(ini, options);
  }
  const bench::SurveyTruth truth(folder);
  const auto pairs = bench::readPairs(folder + "/survey.rawlog", stride);
  const auto configured = bench::score(options, pairs, truth);
  printRow("configured", configured);
  if (!outputs.points.empty()) writePoints(outputs.points, configured);
  if (!outputs.matches.empty()) writeMatches(outputs.matches, configured);
  if (!all) return apps::kSuccess;
  auto literalFeatures = options;
  literalFeatures.stereo.matching.cost = sonar::FeatureCost::Literal;
  printRow("paper's cost, exact", bench::score(literalFeatures, pairs, truth));
  printRow("paper's chain", bench::score(paperLiteral(), pairs, truth));
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures stereo points against the truth of a simulated survey", "measure_stereo");
  std::string folder, config;
  Outputs outputs;
  std::size_t stride = 10;
  bool all = false;
  app.add_option("survey", folder, "Output folder of simulate-survey")->required();
  app.add_option("--config", config, "INI with the sonar sections");
  app.add_option("--csv", outputs.points, "Every point with its distance to the surface");
  app.add_option("--matches", outputs.matches, "Every third match with its distance in truth");
  app.add_option("--stride", stride, "Every how many horizontal pings")->check(CLI::PositiveNumber);
  app.add_flag("--all", all, "The paper's variants beside it");
  return apps::run(app, argc, argv, [&] { return measure(folder, config, outputs, stride, all); });
}
