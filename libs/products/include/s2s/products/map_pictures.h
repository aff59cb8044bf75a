#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "s2s/core/trajectory.h"
#include "s2s/map/map_point.h"
#include "s2s/map/wall_estimator.h"
#include "s2s/products/cloud_statistics.h"
#include "s2s/products/height_datum.h"
#include "s2s/products/height_grid.h"
#include "s2s/products/products_options.h"
#include "s2s/products/survey_frame.h"

namespace s2s::products {

/// What the pictures are made from.
struct PictureContext {
  SurveyFrame frame;
  CloudStatistics statistics;
  core::Trajectory path;  ///< T_map_vehicle
  HeightDatum datum;
  double crossSectionStation_m = 0;
};

/// Gathers map points into pictures of the surroundings of the path; memory follows the pictures' size. All are drawn
/// along the survey: the path's principal direction runs to the right. Images are BGR, 8 bit.
///
/// They are drawn in software, without a display or OpenGL: the same picture on every machine.
class MapPictures {
 public:
  MapPictures(const PictureContext& context, const PictureOptions& options);
  ~MapPictures();
  MapPictures(MapPictures&&) noexcept;
  MapPictures& operator=(MapPictures&&) noexcept;

  void add(const map::MapPoint& point);

  /// Bird's eye view from the side, cut open towards the viewer: LiDAR points nearer than the path are left out.
  cv::Mat oblique() const;
  cv::Mat top() const;
  /// Slab along the path's principal direction, through its middle; heights are exaggerated where needed.
  cv::Mat longSection() const;
  /// Slab across it at `crossSectionStation_m`.
  cv::Mat crossSection() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The seabed grid as depths below the datum with relief shading, axes in metres of the map frame.
cv::Mat drawGrid(const HeightGrid& grid, const HeightDatum& datum, int width_px, int height_px);

/// The faces of walls, upright and seen from the survey: a panel for each of its four sides that has walls, with each
/// cell coloured by how far it stands out of its wall's plane. The width is kept, the height follows from the panels.
/// @param cell_m edge of a cell
cv::Mat drawWalls(const std::vector<map::WallEstimator::Cell>& cells, double cell_m, const SurveyFrame& frame,
                  const HeightDatum& datum, int width_px, int height_px);

}  // namespace s2s::products
