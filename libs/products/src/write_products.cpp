#include "s2s/products/write_products.h"

#include <sys/resource.h>

#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>

#include "picture_drawing.h"
#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/map/CSeabedSkyMap.h"
#include "s2s/products/cloud_statistics.h"
#include "s2s/products/grid_files.h"
#include "s2s/products/las_writer.h"
#include "s2s/products/map_pictures.h"
#include "s2s/products/map_source.h"
#include "s2s/products/mrpt_files.h"
#include "s2s/products/ply_writer.h"
#include "s2s/products/report_page.h"
#include "s2s/products/trajectory_files.h"
#include "s2s/products/wall_files.h"

namespace s2s::products {

namespace {

namespace fs = std::filesystem;

/// Peak resident memory of this process.
double peakRss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// The water surface if the mapper knows it, else the middle height of the path.
HeightDatum heightDatum(const RunSummary& summary, const core::Trajectory& path) {
  if (summary.waterHeight_m) return {*summary.waterHeight_m, true};
  std::vector<double> heights;
  for (const auto& pose : path.poses()) heights.push_back(pose.T.translation().z());
  if (heights.empty()) return {0, false};
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return {*middle, false};
}

/// One call of writeProducts.
class Writing {
 public:
  Writing(const PointSource& points, const Trajectories& trajectories, RunSummary summary,
          const ProductsOptions& options, std::string dir, const std::function<void(const std::string&)>& onFile,
          const map::SurfaceEstimator* surface, const map::WallEstimator* walls)
      : points_(points),
        trajectories_(trajectories),
        options_(options),
        dir_(std::move(dir)),
        onFile_(onFile),
        surface_(surface),
        walls_(walls),
        crossSection_(SurveyFrame(trajectories.optimised, {}), options.pictures.sectionThickness_m) {
    if (!surface_ && wantsGrid()) ownSurface_ = std::make_unique<map::SurfaceEstimator>(options.grid);
    result_.summary = std::move(summary);
    datum_ = heightDatum(result_.summary, trajectories_.optimised);
  }

  ProductsResult run() {
    writeTrajectories();
    firstPass();
    writeGrid();
    writeWalls();
    secondPass();
    writeSummary();
    if (options_.report) writeReport();
    return std::move(result_);
  }

 private:
  std::string begin(const std::string& name) const {
    if (onFile_) onFile_(name);
    return (fs::path(dir_) / name).string();
  }

  void done(const std::string& name) { result_.files.push_back({name, fs::file_size(fs::path(dir_) / name)}); }

  /// Writes one file by `write(path)` and books it.
  template <class Write>
  void file(const std::string& name, const Write& write) {
    write(begin(name));
    done(name);
  }

  void writeTrajectories() {
    file("trajectory.tum", [&](const auto& path) { writeTum(path, trajectories_.optimised); });
    file("odometry.tum", [&](const auto& path) { writeTum(path, trajectories_.odometry); });
    file("keyframes.tum", [&](const auto& path) { writeTum(path, trajectories_.keyframes); });
    if (!options_.kitti) return;
    const std::string times = begin("trajectory_times.txt");
    file("trajectory.kitti", [&](const auto& path) { writeKitti(path, trajectories_.optimised, times); });
    done("trajectory_times.txt");
  }

  /// PLY files, statistics and the seabed's soundings.
  void firstPass() {
    std::unique_ptr<PlyPointWriter> all;
    if (options_.mapPly) all = std::make_unique<PlyPointWriter>(begin("map.ply"), PlyPointWriter::Columns::WithLayer);
    for (const auto layer : map::kLayers) {
      const std::string name = std::string(map::layerName(layer)) + ".ply";
      std::unique_ptr<PlyPointWriter> ply;
      if (options_.ply) ply = std::make_unique<PlyPointWriter>(begin(name));
      points_(layer, [&](const map::MapPoint& point) {
        if (!statistics_.add(point)) return;
        if (ply) ply->add(point);
        if (all) all->add(point);
        if (ownSurface_) ownSurface_->add(point);
        if (options_.report) crossSection_.add(point);
      });
      if (ply) {
        ply->finish();
        done(name);
      }
      result_.summary.points[static_cast<std::size_t>(layer)] = statistics_.layer(layer).count;
    }
    if (all) {
      all->finish();
      done("map.ply");
    }
    if (statistics_.notFinite() > 0)
      warn(std::to_string(statistics_.notFinite()) + " map points were not finite and were left out");
  }

  bool wantsGrid() const { return options_.geoTiff || options_.bag || options_.report; }

  void writeGrid() {
    if (!wantsGrid()) return;
    try {
      // Without a water surface no sounding can be too near to it.
      const double water_m = result_.summary.waterHeight_m.value_or(std::numeric_limits<double>::infinity());
      grid_ = gridOf(surface_ ? *surface_ : *ownSurface_, water_m, options_.grid, &result_.seabed);
    } catch (const core::OutputError& error) {  // too large: no reason to lose the rest of the map
      result_.seabed = {};
      warn("no seabed grid: " + error.fault() + "; " + error.remedy());
      return;
    }
    ownSurface_.reset();
    if (grid_.columns == 0) {
      warn("no seabed grid: too few soundings in every cell");
      return;
    }
    result_.summary.figures.emplace_back("seabed_area_m2", result_.seabed.area_m2);
    result_.summary.figures.emplace_back("seabed_lowest_height_m", result_.seabed.minHeight_m);
    result_.summary.figures.emplace_back("seabed_highest_height_m", result_.seabed.maxHeight_m);
    if (options_.geoTiff) file("seabed.tif", [&](const auto& path) { writeGeoTiff(path, grid_); });
    if (options_.bag) file("seabed.bag", [&](const auto& path) { writeBag(path, grid_, result_.summary.startTime); });
  }

  void writeWalls() {
    if (!walls_ || !options_.walls) return;
    wallCells_ = wallCells(*walls_);
    if (wallCells_.empty()) return;
    const WallStatistics statistics = wallStatistics(wallCells_, walls_->options().cell_m);
    result_.summary.figures.emplace_back("wall_area_by_lidar_m2", statistics.lidarArea_m2);
    result_.summary.figures.emplace_back("wall_area_by_sonar_m2", statistics.sonarArea_m2);
    file("walls.ply", [&](const auto& path) { writeWallPly(path, wallCells_); });
  }

  MapColours colours() const {
    return {datum_.height_m, statistics_.heightQuantile_m({map::Layer::Lidar}, 0.98),
            statistics_.heightQuantile_m(map::kSonarLayers, 0.01), datum_.height_m};
  }

  PictureContext pictureContext() const {
    PictureContext context;
    context.frame = SurveyFrame(trajectories_.optimised, statistics_);
    context.statistics = statistics_;
    context.path = trajectories_.optimised;
    context.datum = datum_;
    context.crossSectionStation_m = crossSection_.station_m();
    return context;
  }

  LasFrame lasFrame() const {
    LasFrame frame;
    // The path's middle rather than the data's: a single stray point far away cannot push the offset off the survey.
    const Eigen::Vector2d middle_m = SurveyFrame(trajectories_.optimised, statistics_).middle_m;
    frame.offset_m = {std::round(middle_m.x()), std::round(middle_m.y()), 0};
    frame.surveyTime = result_.summary.startTime;
    for (const auto layer : map::kLayers)
      frame.intensityFactor[static_cast<std::size_t>(layer)] =
          lasIntensityFactor(statistics_.layer(layer).maxIntensity);
    return frame;
  }

  /// What needs the statistics first: LAS, scene, simple map.
  void secondPass() {
    std::unique_ptr<LasWriter> las;
    std::unique_ptr<SceneBuilder> scene;
    std::unique_ptr<SimpleMapBuilder> simpleMap;
    if (options_.picture || options_.report)
      pictures_ = std::make_unique<MapPictures>(pictureContext(), options_.pictures);
    const auto stride = [&](int limit) { return strideFor(statistics_.count(), static_cast<std::uint64_t>(limit)); };
    if (options_.las) las = std::make_unique<LasWriter>(begin("map.las"), lasFrame());
    if (options_.scene) scene = std::make_unique<SceneBuilder>(colours(), stride(options_.sceneMaxPoints));
    if (options_.simpleMap)
      simpleMap = std::make_unique<SimpleMapBuilder>(trajectories_.keyframes, stride(options_.simpleMapMaxPoints));
    std::uint64_t outsideLas = 0;
    for (const auto layer : map::kLayers)
      points_(layer, [&](const map::MapPoint& point) {
        if (!point.p_map.allFinite()) return;
        if (las && !las->add(point)) ++outsideLas;
        if (scene) scene->add(point);
        if (simpleMap) simpleMap->add(point);
        if (pictures_) pictures_->add(point);
      });
    if (outsideLas > 0) warn(std::to_string(outsideLas) + " points lie too far away for LAS and were left out of it");
    if (las) {
      las->finish();
      done("map.las");
    }
    if (scene)
      file("map.3Dscene", [&](const auto& path) {
        scene->write(path, trajectories_.optimised, trajectories_.keyframes, result_.summary.waterHeight_m);
      });
    if (simpleMap) file("map.simplemap", [&](const auto& path) { simpleMap->write(path); });
    if (options_.picture) file("map.png", [&](const auto& path) { writePicture(path, pictures_->oblique()); });
  }

  void writeSummary() {
    const double products_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    result_.summary.wall_s += products_s;
    result_.summary.stageTimes_s.emplace_back("products", products_s);
    result_.summary.peakRss_mb = std::max(result_.summary.peakRss_mb, peakRss_mb());
    file("summary.json", [&](const auto& path) { core::writeTextFile(path, toJson(result_.summary)); });
  }

  void writeReport() {
    ReportContent content;
    content.summary = result_.summary;
    content.seabed = result_.seabed;
    content.gridCell_m = options_.grid.cell_m;
    content.pictures = reportPictures();
    for (const auto& written : result_.files) content.files.push_back({written.name, written.bytes});
    file("report.html", [&](const auto& path) { core::writeTextFile(path, reportPage(content)); });
  }

  std::vector<ReportPicture> reportPictures() const {
    // Point clouds are noisy and thrice as large as PNG; what is drawn with lines stays sharp as PNG.
    std::vector<ReportPicture> out = {{"The map from the side",
                                       "LiDAR points by height, sonar points by depth; cut open towards the viewer: "
                                       "LiDAR points nearer than the path "
                                       "are left out. Parallel projection, so the scale bar holds across the picture.",
                                       "image/jpeg", encode(pictures_->oblique(), ".jpg")},
                                      {"The map from above", "The path's principal direction runs to the right.",
                                       "image/jpeg", encode(pictures_->top(), ".jpg")}};
    if (grid_.columns > 0)
      out.push_back({"Seabed grid", "Median depths in cells of the map frame, with relief shading; white: no height.",
                     "image/png",
                     encode(drawGrid(grid_, datum_, options_.pictures.width_px, options_.pictures.height_px), ".png")});
    if (!wallCells_.empty())
      out.push_back({"Walls",
                     "Their faces as in walls.ply, upright and seen from the survey: blue where a face lies behind the "
                     "plane of its wall, red where it stands out.",
                     "image/png",
                     encode(drawWalls(wallCells_, walls_->options().cell_m, SurveyFrame(trajectories_.optimised, {}),
                                      datum_, options_.pictures.width_px, options_.pictures.height_px),
                            ".png")});
    out.push_back({"Cross section", "A slab across the survey, where LiDAR and sonar see most together.", "image/png",
                   encode(pictures_->crossSection(), ".png")});
    out.push_back({"Long section", "A slab along the survey, through the middle of the path.", "image/png",
                   encode(pictures_->longSection(), ".png")});
    return out;
  }

  void warn(const std::string& text) { result_.summary.warnings.push_back(text); }

  const PointSource& points_;
  const Trajectories& trajectories_;
  const ProductsOptions& options_;
  std::string dir_;
  const std::function<void(const std::string&)>& onFile_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  HeightDatum datum_;
  CloudStatistics statistics_;
  const map::SurfaceEstimator* surface_;
  const map::WallEstimator* walls_;
  std::unique_ptr<map::SurfaceEstimator> ownSurface_;  ///< if none was given
  CrossSectionFinder crossSection_;
  HeightGrid grid_;
  std::vector<map::WallEstimator::Cell> wallCells_;
  std::unique_ptr<MapPictures> pictures_;
  ProductsResult result_;
};

}  // namespace

ProductsResult writeProducts(const PointSource& points, const Trajectories& trajectories, RunSummary summary,
                             const ProductsOptions& options, const std::string& dir,
                             const std::function<void(const std::string&)>& onFile,
                             const map::SurfaceEstimator* surface, const map::WallEstimator* walls) {
  return Writing(points, trajectories, std::move(summary), options, dir, onFile, surface, walls).run();
}

ProductsResult writeProducts(const map::CSeabedSkyMap& map, const Trajectories& trajectories, RunSummary summary,
                             const ProductsOptions& options, const std::string& dir,
                             const std::function<void(const std::string&)>& onFile) {
  return writeProducts(pointsOf(map), trajectories, std::move(summary), options, dir, onFile, &map.surface(),
                       &map.walls());
}

}  // namespace s2s::products
