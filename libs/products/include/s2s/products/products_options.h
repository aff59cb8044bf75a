#pragma once

#include "s2s/map/wall_estimator.h"
#include "s2s/products/seabed_gridder.h"

namespace s2s::products {

/// Pictures of the map.
struct PictureOptions {
  int width_px = 1600;
  int height_px = 1000;           ///< at most; wide and low surveys take less
  double margin_m = 25;           ///< how far around the path the pictures reach
  double sectionThickness_m = 2;  ///< of the slabs that the section pictures show
};

/// What `writeProducts` writes. Trajectories and the summary are always written.
struct ProductsOptions {
  bool ply = true;      ///< one PLY a layer
  bool mapPly = false;  ///< `map.ply`: all layers in one file, with a column `layer`
  bool las = true;
  bool geoTiff = true;
  bool bag = true;
  bool walls = true;               ///< `walls.ply`: the faces of walls that sonars have met
  bool scene = true;               ///< MRPT `.3Dscene`
  bool simpleMap = false;          ///< MRPT `.simplemap`
  bool kitti = false;              ///< the trajectory in KITTI form too
  bool picture = true;             ///< `map.png`
  bool report = true;              ///< `report.html`
  int sceneMaxPoints = 3'000'000;  ///< more make MRPT's viewer slow; the rest is left out evenly
  int simpleMapMaxPoints = 5'000'000;
  SeabedGridOptions grid;
  map::WallSurfaceOptions wallSurface;
  PictureOptions pictures;
};

}  // namespace s2s::products
