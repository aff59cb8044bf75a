#include "s2s/sonar/options_table.h"

#include <sstream>

namespace s2s::sonar {

namespace {

constexpr core::Range kShare{0, 1};

bool parseSteps(const std::string& text, std::vector<PreprocessStep>& steps) {
  std::vector<PreprocessStep> parsed;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    bool known = false;
    for (const PreprocessStep step : allPreprocessSteps()) {
      if (word != stepName(step)) continue;
      parsed.push_back(step);
      known = true;
    }
    if (!known && word != "none") return false;
  }
  steps = parsed;
  return true;
}

std::string printSteps(const std::vector<PreprocessStep>& steps) {
  std::string text;
  for (const PreprocessStep step : steps) text += (text.empty() ? "" : " ") + std::string(stepName(step));
  return text.empty() ? "none" : text;
}

std::string expectedSteps() {
  std::string text = "'none' or, in the order of execution, words out of";
  for (const PreprocessStep step : allPreprocessSteps()) text += " " + std::string(stepName(step));
  return text;
}

using Section = std::pair<std::string, core::OptionTable>;

std::vector<Section> deviceSections(const std::string& section, DeviceOptions& o) {
  return {{section + ".preprocess", optionTable(o.preprocess)},
          {section + ".leading_edge", optionTable(o.leadingEdge)},
          {section + ".cfar", optionTable(o.cfar)},
          {section + ".features", optionTable(o.features)}};
}

std::vector<Section> stereoSections(StereoOptions& o) {
  return {{"sonar.stereo", optionTable(o)},
          {"sonar.stereo.dbscan", optionTable(o.dbscan)},
          {"sonar.stereo.clusters", optionTable(o.clusters)},
          {"sonar.stereo.matching", optionTable(o.matching)}};
}

std::string print(const std::vector<Section>& sections) {
  std::string text;
  for (const auto& [name, table] : sections) text += table.print(name) + "\n";
  return text;
}

}  // namespace

core::OptionTable optionTable(PreprocessOptions& o) {
  core::OptionTable table;
  table.addParsed(
      "steps", "steps in the order of execution, or none", expectedSteps(),
      [&o](const std::string& text) { return parseSteps(text, o.steps); }, [&o] { return printSteps(o.steps); });
  table.add("row_quantile", o.rowQuantile, "row_quantile: quantile of each range row that is subtracted", kShare);
  table.addDegrees("center_half_width_deg", o.centerHalfWidth_rad,
                   "center_removal: beams up to this angle from the central one", {0, 180});
  table.add("center_level", o.centerLevel, "center_removal: share of the strongest pixel below which is cleared",
            kShare);
  table.add("normalise_quantile", o.normaliseQuantile, "normalise: quantile of the non-zero pixels that becomes 255",
            kShare);
  table.add("opening_bins", o.openingBins, "opening: kernel height in range bins", {1, 99});
  table.add("opening_beams", o.openingBeams, "opening: kernel width in beams", {1, 99});
  table.add("median_size", o.medianSize, "median: kernel size, 3 or 5", {3, 5});
  return table;
}

core::OptionTable optionTable(LeadingEdgeOptions& o) {
  core::OptionTable table;
  table.add("threshold", o.threshold, "intensity (of 255) that an edge exceeds", {0, 255});
  table.add("min_range_m", o.minRange_m, "nearer bins are ignored (ring-down of the transducer)", core::atLeast(0));
  table.add("max_returns", o.maxReturns, "returns kept of each beam; more than 1 finds surfaces behind the first",
            {1, 100});
  table.add("return_gap_m", o.returnGap_m, "a further return begins after this length below the threshold",
            core::atLeast(0));
  table.add("range_sigma_m", o.rangeSigma_m, "standard deviation of an edge's range, without the bin's rounding",
            core::atLeast(0));
  table.addDegrees("bearing_sigma_deg", o.bearingSigma_rad, "standard deviation of a beam's bearing", core::atLeast(0));
  table.addDegrees("speckle_window_deg", o.speckleWindow_rad,
                   "returns up to this angle from a beam tell how late speckle makes its edge; 0: the paper's edge",
                   {0, 20});
  table.add("ridges", o.ridges, "bright surfaces behind the first, such as a wall behind the bed, are returns too");
  table.add("ridge_level", o.ridgeLevel, "intensity (of 255) that a ridge exceeds in the mean", {0, 255});
  table.add("ridge_contrast", o.ridgeContrast, "and how many times the mean echo in front of it", core::atLeast(1));
  table.add("ridge_length_m", o.ridgeLength_m, "length over which a ridge's mean is taken", core::positive());
  table.addDegrees("ridge_window_deg", o.ridgeWindow_rad,
                   "ridges within this angle of a beam make a straight line, which gives its range; 0: each by itself",
                   {0, 20});
  return table;
}

core::OptionTable optionTable(CfarOptions& o) {
  core::OptionTable table;
  table.addChoice("kind", o.kind,
                  {{"soca", CfarKind::SmallestOf},
                   {"ca", CfarKind::CellAverage},
                   {"goca", CfarKind::GreatestOf},
                   {"os", CfarKind::OrderedStatistic}},
                  "how the noise level is taken from both sides of a cell");
  table.add("reference_cells", o.referenceCells, "cells that give the noise level, both sides together", {2, 1000});
  table.add("guard_cells", o.guardCells, "cells left out around the tested one, both sides together", {0, 1000});
  table.add("false_alarm_probability", o.falseAlarmProbability, "probability of a detection in mere noise",
            {1e-9, 0.999});
  table.add("min_intensity", o.minIntensity, "least intensity (of 255) of a detection", {0, 255});
  table.add("ordered_rank", o.orderedRank, "os: rank of the cell taken, as a share of all", kShare);
  return table;
}

core::OptionTable optionTable(FeatureOptions& o) {
  core::OptionTable table;
  table.add("context_step_m", o.contextStep_m, "distance to the neighbours whose intensity is averaged",
            core::positive());
  table.addDegrees("max_run_width_deg", o.maxRunWidth_rad,
                   "runs of neighbouring beams up to this width share the bearing of their centre; 0 switches it off",
                   {0, 180});
  table.add("range_sigma_m", o.rangeSigma_m, "standard deviation of a feature's range, without the bin's rounding",
            core::positive());
  table.addDegrees("bearing_sigma_deg", o.bearingSigma_rad, "standard deviation of a feature's bearing",
                   core::positive());
  return table;
}

core::OptionTable optionTable(DbscanOptions& o) {
  core::OptionTable table;
  table.add("epsilon_m", o.epsilon_m, "neighbourhood radius", core::positive());
  table.add("min_points", o.minPoints, "points within the radius, the point itself included, that make a core point",
            {1, 1000000});
  return table;
}

core::OptionTable optionTable(ClusterAssociationOptions& o) {
  core::OptionTable table;
  table.addChoice("cost", o.cost, {{"normalised", ClusterCost::Normalised}, {"literal", ClusterCost::Literal}},
                  "normalised: standard deviation in place of the paper's variance");
  table.addChoice(
      "pairing", o.pairing,
      {{"nearest", ClusterPairing::Nearest}, {"both", ClusterPairing::Both}, {"overlap", ClusterPairing::Overlap}},
      "which clusters may show the same surface");
  table.add("max_gap_m", o.maxGap_m, "largest distance between the x intervals of two such clusters", core::atLeast(0));
  return table;
}

core::OptionTable optionTable(FeatureAssociationOptions& o) {
  core::OptionTable table;
  table.addChoice("cost", o.cost, {{"geometric", FeatureCost::Geometric}, {"literal", FeatureCost::Literal}},
                  "geometric: residual of the triangulation; literal: the paper's descriptors");
  table.add("max_residual", o.maxResidual, "geometric: largest range misfit in standard deviations", core::positive());
  table.add("intensity_weight", o.intensityWeight, "geometric: weight of the squared difference in intensity",
            core::atLeast(0));
  table.addDegrees("aperture_margin_deg", o.apertureMargin_rad, "points may lie outside an aperture by this", {0, 90});
  table.add("max_cost", o.maxCost, "geometric: largest cost of a match, surface and intensity included",
            core::positive());
  table.add("literal_neighbours", o.literalNeighbours, "literal: candidates of each horizontal feature", {1, 100000});
  table.addChoice("ambiguity", o.ambiguity,
                  {{"ignore", AmbiguityRule::Ignore}, {"keep", AmbiguityRule::Keep}, {"reject", AmbiguityRule::Reject}},
                  "what happens when several candidates are almost as good");
  table.add("ambiguity_cost", o.ambiguityCost, "candidates within this cost of the best are almost as good",
            core::atLeast(0));
  table.add("max_spread_m", o.maxSpread_m, "reject: allowed distance between the points of such candidates",
            core::atLeast(0));
  table.add("surface", o.surface.enabled, "geometric: fit a smooth surface to each cluster and let it choose");
  table.addDegrees("surface_sigma_deg", o.surfaceSigma_rad, "surface: elevations off it by this cost one unit",
                   core::positive());
  table.add("surface_max_scatter", o.surface.maxEdgeScatter,
            "surface: refused if the edges of the beams scatter more, as a share of the range", core::positive());
  table.addParsed(
      "optimal_edges", "problems up to this many candidates are solved optimally, larger ones by an auction",
      "a whole number, at least 0",
      [&o](const std::string& text) {
        int value = 0;
        if (!core::parseInt(text, value) || value < 0) return false;
        o.assignment.optimalEdges = static_cast<std::size_t>(value);
        return true;
      },
      [&o] { return std::to_string(o.assignment.optimalEdges); });
  table.add("relative_gap", o.assignment.relativeGap, "auction: aimed excess over the optimal cost", {1e-6, 1});
  return table;
}

core::OptionTable optionTable(StereoOptions& o) {
  core::OptionTable table;
  table.addChoice("fusion", o.triangulation.fusion,
                  {{"average", Fusion::Average}, {"coordinate", Fusion::Coordinate}, {"exact", Fusion::Exact}},
                  "how a matched pair becomes a point");
  table.add("max_iterations", o.triangulation.maxIterations, "exact: steps of the least squares", {1, 1000});
  table.add("max_residual", o.maxResidual, "exact: largest residual of a point in standard deviations",
            core::positive());
  table.add("max_point_sigma_m", o.maxPointSigma_m, "exact: largest standard deviation of a point", core::positive());
  return table;
}

void loadDevice(core::IniFile& ini, const std::string& section, DeviceOptions& options) {
  for (auto& [name, table] : deviceSections(section, options)) table.load(ini, name);
}

void loadSonars(core::IniFile& ini, SonarOptions& options) {
  loadDevice(ini, "sonar.horizontal", options.horizontal);
  loadDevice(ini, "sonar.vertical", options.vertical);
  for (auto& [name, table] : stereoSections(options.stereo)) table.load(ini, name);
}

std::string printDevice(const std::string& section, DeviceOptions options) {
  return print(deviceSections(section, options));
}

std::string printSonars(SonarOptions options) {
  return printDevice("sonar.horizontal", options.horizontal) + printDevice("sonar.vertical", options.vertical) +
         print(stereoSections(options.stereo));
}

}  // namespace s2s::sonar
