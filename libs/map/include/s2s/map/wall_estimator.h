#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>

#include "s2s/map/map_point.h"
#include "s2s/map/sparse_grid.h"

namespace s2s::map {

class SurfaceTiles;

/// How points become the surface of a wall.
struct WallSurfaceOptions {
  double cell_m = 0.25;        ///< edge of a cell, along the wall and in height
  int minPoints = 3;           ///< points a cell needs
  double reach_m = 0.3;        ///< points this near to the plane first seen of a wall are of it
  double sigmaFloor_m = 0.01;  ///< smallest standard deviation that a single point is believed to have
  double planeReach_m = 5;     ///< offsets are from the plane through what lies within this distance along the wall
  int maxTilesInMemory = 256;  ///< as in SurfaceOptions
};

/// Walls as surfaces: for each cell along a wall and up it, how far its face stands out of the wall's plane, with an
/// uncertainty. The sonars' and the LiDAR's are kept apart, so that each can be held against the other.
///
/// The same design as SurfaceEstimator: histograms of 1 cm in tiles, any point can be taken out again exactly, so that
/// it grows as pings come and moves when the graph does. Instead of heights the histograms hold distances along one of
/// 72 directions, 5 degrees apart; which one is fixed where a wall is first met, per place of half a metre. A cell is
/// 0.25 m long, so that a direction off the wall's normal by 2.5 degrees adds 5 mm to its scatter at the most.
///
/// Of the sonars' points those count that are known to lie on a wall, and stereo points within reach of one; of the
/// LiDAR's those within reach. Points that came before their wall was known count from when they are entered anew.
class WallEstimator {
 public:
  struct Cell {
    Eigen::Vector3d p_map = Eigen::Vector3d::Zero();        ///< middle of the cell, on the estimated face
    Eigen::Vector2d outward_map = Eigen::Vector2d::Zero();  ///< horizontal normal towards where the wall was seen from
    double offset_m = 0;                                    ///< out of the wall's plane, positive outward: a bulge
    /// As in SurfaceEstimator: of what a single ping tells; of a sonar's cell also of the profile around it that the
    /// LiDAR shows and the sonar does not resolve.
    double sigma_m = 0;
    std::uint32_t count = 0;
    bool bySonar = false;  ///< else by the LiDAR
  };

  explicit WallEstimator(const WallSurfaceOptions& options = {});
  ~WallEstimator();
  WallEstimator(WallEstimator&&) noexcept;
  WallEstimator& operator=(WallEstimator&&) noexcept;

  const WallSurfaceOptions& options() const { return options_; }
  void clear();

  /// True if a wall is known at a place (x, y).
  bool knows(const Eigen::Vector2d& place_m) const;
  /// A wall n . (x, y) = d is met at a place: its direction is settled there and in the cells around that it passes,
  /// unless it is already.
  /// @param outward n, of unit length, towards the side it is seen from
  void learn(const Eigen::Vector2d& place_m, const Eigen::Vector2d& outward, double distance_m);
  /// Changes whenever something is learnt.
  std::uint64_t epoch() const { return epoch_; }

  /// @throws core::OutputError if tiles cannot be put away, the disk being full
  void add(const MapPoint& point) { enter(point, 1, epoch_); }
  /// The inverse of `add`: place, sigma and time must be the same, and the epoch that of then.
  void remove(const MapPoint& point, std::uint64_t epoch) { enter(point, -1, epoch); }

  /// Visits every cell with enough points, in order of direction and place.
  void forEachCell(const std::function<void(const Cell&)>& visit) const;

 private:
  struct Known {
    std::int32_t sector = -1;  ///< negative: no wall
    double distance_m = 0;     ///< of the plane here, along the sector's direction
    std::uint64_t epoch = 0;
  };
  void enter(const MapPoint& point, int sign, std::uint64_t epoch);

  WallSurfaceOptions options_;
  std::unique_ptr<SurfaceTiles> tiles_;
  SparseGrid<Known> known_;
  std::uint64_t epoch_ = 0;
};

}  // namespace s2s::map
