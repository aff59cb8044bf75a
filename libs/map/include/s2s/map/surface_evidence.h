#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "s2s/map/options.h"
#include "s2s/map/sparse_grid.h"

namespace s2s::map {

/// What is known of the surfaces around: a height grid of the seabed, and vertical walls, each gathered point by point.
/// All coordinates are in the map's frame.
class SurfaceEvidence {
 public:
  struct Seabed {
    double height_m = 0;  ///< z of the seabed
    double sigma_m = 0;   ///< standard deviation of the height
  };
  /// A vertical plane: n . (x, y) = d.
  struct Wall {
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();
    double offset_m = 0;
    double sigma_m = 0;  ///< spread of the points around the plane
    double top_m = 0;    ///< z of the highest point seen of it
  };

  void reset(const ResolverOptions& options);

  /// Evidence of the seabed only.
  void addSeabedPoint(const Eigen::Vector3d& p_map, double sigma_m);
  /// Evidence of walls only.
  void addWallPoint(const Eigen::Vector3d& p_map);

  /// The seabed at a place, mixed bilinearly from the cells around that know it.
  std::optional<Seabed> seabedAt(double x_m, double y_m) const;
  /// The nearest wall that passes through the cell of this place or one of its neighbours: the mean of those cells'
  /// planes that agree with the nearest one.
  std::optional<Wall> wallNear(double x_m, double y_m) const;

  std::size_t wallCount() const { return wallCount_; }

 private:
  /// Points of a column between two heights.
  struct Slab {
    int bin = 0;
    float count = 0, weight = 0, weightedZ = 0, weightedZZ = 0;
  };
  struct Column {
    std::vector<Slab> slabs;           // by bin
    float height_m = 0, sigma_m = -1;  // negative: not known yet
  };
  /// First and second moments in x and y, relative to the cell's corner, of the points between two heights.
  struct Moments {
    int bin = 0;
    float count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, bottom_m = 0, top_m = 0;
  };
  struct WallCell {
    std::vector<Moments> moments;
    Wall wall;
    bool isWall = false;
  };

  void updateSeabed(Column& column) const;
  void updateWall(WallCell& cell, const Eigen::Vector2d& corner_m);

  ResolverOptions options_;
  SparseGrid<Column> seabed_{0.25};
  SparseGrid<WallCell> walls_{0.5};
  std::size_t wallCount_ = 0;
};

}  // namespace s2s::map
