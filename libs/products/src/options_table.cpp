#include "s2s/products/options_table.h"

namespace s2s::products {

namespace {

void addGrid(core::OptionTable& table, SeabedGridOptions& grid) {
  table.add("grid_cell_m", grid.cell_m, "edge of a seabed grid cell", {0.01, 100})
      .add("grid_min_points", grid.minPoints, "soundings a cell needs", core::atLeast(1))
      .add("grid_min_depth_m", grid.minDepth_m, "soundings nearer to the water surface are not used", core::atLeast(0))
      .add("grid_flat_spread_m", grid.flatSpread_m, "a cell whose soundings span more holds more than seabed",
           {0.05, 10})
      .add("grid_window_m", grid.window_m, "height of the layer in which the seabed of such a cell is sought",
           {0.05, 10})
      .add("grid_min_seabed_share", grid.minSeabedShare,
           "share of its weight that this layer must hold, else it is a wall", {0, 1})
      .add("grid_max_step_m", grid.maxStep_m, "a cell that differs more from its neighbours is no seabed",
           core::positive())
      .add("grid_max_doubtful_step_m", grid.maxDoubtfulStep_m, "the same for a cell that holds more than seabed",
           core::positive())
      .add("grid_sigma_floor_m", grid.sigmaFloor_m, "smallest standard deviation believed of a sounding", {0.001, 10})
      .add("grid_max_tiles", grid.maxTilesInMemory,
           "tiles of 32 x 32 cells in memory; those not used lately go to a temporary file", core::atLeast(1))
      .add("grid_max_cells", grid.maxCells, "a larger grid is refused", core::atLeast(1));
}

void addWalls(core::OptionTable& table, map::WallSurfaceOptions& walls) {
  table.add("wall_cell_m", walls.cell_m, "edge of a cell of a wall's face", {0.01, 10})
      .add("wall_min_points", walls.minPoints, "points such a cell needs", core::atLeast(1))
      .add("wall_reach_m", walls.reach_m, "points this near to a wall's plane are of its face", {0.01, 2})
      .add("wall_sigma_floor_m", walls.sigmaFloor_m, "smallest standard deviation believed of a point of it",
           {0.001, 10})
      .add("wall_plane_reach_m", walls.planeReach_m, "offsets are from the plane of what lies within this distance",
           {0.5, 1000})
      .add("wall_max_tiles", walls.maxTilesInMemory,
           "tiles of 32 x 32 cells in memory; those not used lately go to a temporary file", core::atLeast(1));
}

}  // namespace

core::OptionTable optionTable(ProductsOptions& options) {
  core::OptionTable table;
  table.add("ply", options.ply, "lidar.ply, stereo.ply, line_horizontal.ply, line_vertical.ply")
      .add("map_ply", options.mapPly, "map.ply with all layers")
      .add("las", options.las, "map.las")
      .add("geotiff", options.geoTiff, "seabed.tif")
      .add("bag", options.bag, "seabed.bag")
      .add("walls", options.walls, "walls.ply: the faces of walls that sonars have met, with bulges and sigma")
      .add("scene", options.scene, "map.3Dscene for MRPT's SceneViewer3D")
      .add("simplemap", options.simpleMap, "map.simplemap for MRPT's map programs")
      .add("kitti", options.kitti, "trajectory.kitti and trajectory_times.txt")
      .add("picture", options.picture, "map.png")
      .add("report", options.report, "report.html")
      .add("scene_max_points", options.sceneMaxPoints, "points in map.3Dscene; the rest is left out evenly", {1, 1e9})
      .add("simplemap_max_points", options.simpleMapMaxPoints, "points in map.simplemap", {1, 1e9});
  addGrid(table, options.grid);
  addWalls(table, options.wallSurface);
  return table.add("picture_width_px", options.pictures.width_px, "width of the pictures", {320, 8192})
      .add("picture_height_px", options.pictures.height_px, "largest height of the pictures", {240, 8192})
      .add("picture_margin_m", options.pictures.margin_m, "how far around the path the pictures reach", {0, 10'000})
      .add("section_thickness_m", options.pictures.sectionThickness_m, "thickness of the section pictures' slabs",
           {0.05, 100});
}

}  // namespace s2s::products
