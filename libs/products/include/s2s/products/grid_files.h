#pragma once

#include <string>

#include "s2s/core/time.h"
#include "s2s/products/height_grid.h"

namespace s2s::products {

/// The coordinate reference of everything that is written: a local engineering system in metres, axes x and y
/// horizontal and z up, origin at the first keyframe; as OGC WKT 1.
std::string localCrsWkt();

/// GeoTIFF with the float bands `height_m` (z up), `sigma_m` and `count`, north up, no-data -9999.
/// @throws core::OutputError
void writeGeoTiff(const std::string& path, const HeightGrid& grid);

/// BAG (Bathymetric Attributed Grid): elevation (z up, map frame) and uncertainty. The format has no place for a local
/// reference, so it names a Transverse Mercator stand-in around 0 N 0 E whose name says that it is not georeferenced.
/// @param surveyTime goes into the metadata as the date
/// @throws core::OutputError, also if the grid has no cells or GDAL was built without BAG
void writeBag(const std::string& path, const HeightGrid& grid, core::TimeNs surveyTime);

/// Reads a grid that `writeGeoTiff` wrote, or any north-up raster with square cells whose first band is a height in
/// metres; bands `sigma_m` and `count` are taken when they are there.
/// @throws core::InputError
HeightGrid readGrid(const std::string& path);

}  // namespace s2s::products
