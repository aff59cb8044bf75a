#include "s2s/eval/quality_report.h"

#include "s2s/eval/layer_distance.h"
#include "s2s/eval/map_folder.h"
#include "s2s/products/ply_reader.h"

namespace s2s::eval {

namespace {

void measureCrispness(const std::string& file, map::Layer layer, const QualityOptions& options, QualityReport& report) {
  PointSample places(options.places);
  products::forEachPlyPoint(file, [&](const products::PlyPoint& point) {
    if (point.p.allFinite()) places.add(point.p);
  });
  MapEntropy entropy(places.points(), options.entropyRadius_m);
  products::forEachPlyPoint(file, [&](const products::PlyPoint& point) {
    if (point.p.allFinite()) entropy.add(point.p);
  });
  report.points[layer] = places.offered();
  report.crispness[layer] = entropy.result();
}

std::size_t countHolidays(const products::HeightGrid& grid) {
  std::size_t holidays = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (grid.hasValue(column, row)) continue;
      int neighbours = 0;
      for (int i = -1; i <= 1; ++i)
        for (int k = -1; k <= 1; ++k)
          if (grid.inside(column + i, row + k) && grid.hasValue(column + i, row + k)) ++neighbours;
      if (neighbours >= 5) ++holidays;
    }
  return holidays;
}

GridQuality measureGrid(const MapFolder& map, const products::HeightGrid& grid, const QualityOptions& options) {
  GridQuality quality;
  std::vector<double> soundings, sigmas_m;
  for (std::size_t i = 0; i < grid.height_m.size(); ++i) {
    if (std::isnan(grid.height_m[i])) continue;
    soundings.push_back(grid.count[i]);
    sigmas_m.push_back(static_cast<double>(grid.sigma_m[i]));
  }
  quality.cells = soundings.size();
  quality.area_m2 = static_cast<double>(quality.cells) * grid.cell_m * grid.cell_m;
  quality.soundings = summarise(std::move(soundings));
  quality.sigma_m = summarise(std::move(sigmas_m));
  quality.holidays = countHolidays(grid);
  PassComparison passes(grid, options.passes);
  for (const map::Layer layer : map::kSonarLayers)
    if (const auto file = map.layerFile(layer))
      products::forEachPlyPoint(*file, [&](const products::PlyPoint& point) { passes.add(point.p, point.time_s); });
  quality.passes = passes.result();
  return quality;
}

}  // namespace

QualityReport evaluateQuality(const std::string& mapFolder, const QualityOptions& options) {
  const MapFolder map(mapFolder);
  QualityReport report;
  for (const map::Layer layer : map::kLayers) {
    if (const auto file = map.layerFile(layer))
      measureCrispness(*file, layer, options, report);
    else
      report.notes.push_back(std::string("layer ") + map::layerName(layer) + ": no such file in the map folder");
  }
  if (const auto grid = map.seabed())
    report.seabed = measureGrid(map, *grid, options);
  else
    report.notes.emplace_back("seabed: no seabed.tif in the map folder");
  return report;
}

}  // namespace s2s::eval
