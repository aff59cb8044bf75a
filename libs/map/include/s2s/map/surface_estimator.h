#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "s2s/map/map_point.h"

namespace s2s::map {

class SurfaceTiles;

/// How soundings become a surface.
struct SurfaceOptions {
  double cell_m = 0.5;
  int minPoints = 3;             ///< soundings a cell needs
  double minDepth_m = 0.3;       ///< soundings nearer to the water surface are not used
  double flatSpread_m = 0.6;     ///< a cell whose soundings span more than this holds more than seabed
  double window_m = 0.4;         ///< height of the layer in which the seabed of such a cell is sought
  double minSeabedShare = 0.25;  ///< share of such a cell's weight that the layer must hold, else it is a wall
  double sigmaFloor_m = 0.02;    ///< smallest standard deviation that a single sounding is believed to have
  int maxTilesInMemory = 256;    ///< tiles of 32 x 32 cells; those least recently used beyond go to a temporary file
};

/// What became of soundings and cells.
struct SurfaceStatistics {
  std::uint64_t soundings = 0;   ///< offered, of the sonar layers, and not removed
  std::uint64_t notFinite = 0;   ///< of these: no place, left out
  std::uint64_t tooShallow = 0;  ///< of the soundings: above `minDepth_m`
  std::uint64_t fewPoints = 0;   ///< cells with fewer than `minPoints`
  std::uint64_t walls = 0;       ///< cells that hold nothing but wall
};

/// The seabed as a surface with an uncertainty for each cell, from all acoustic evidence: stereo points and line-scan
/// returns at the elevations that arcs, profiles and free space have decided, weighted by what they are uncertain by.
///
/// It grows as pings come, and any sounding can be taken out again exactly: so when the graph moves, scans that moved
/// are taken out at their old places and put in at their new ones. Each cell keeps a histogram of its soundings'
/// heights (1 cm), so memory follows the area and not the number of soundings, and only `maxTilesInMemory` tiles are in
/// memory at a time.
///
/// The height is the median weighted by 1/sigma². Where a cell spans more than `flatSpread_m`, as at a quay wall, it is
/// the weighted median inside the lowest layer of `window_m` that is at least half as dense as the densest: neither the
/// wall above nor a few false echoes below move it. LiDAR points and points known to lie on walls are passed over.
///
/// The stated sigma is sqrt((v + m s²) / (1 + m)): v the weighted mean of the soundings' own variances, s the scatter
/// about the median (1.4826 MAD), m the pings in the cell. So what the soundings claim counts as one ping, and how far
/// the pings agree decides the more of them there are. It is a single ping's sigma and not divided by their number,
/// since mounting, pose and elevation errors are common to neighbouring pings.
class SurfaceEstimator {
 public:
  struct Cell {
    std::int32_t column = 0, row = 0;  ///< covers [column, column + 1) * cell_m in x, rows in y likewise
    double height_m = 0, sigma_m = 0;
    std::uint32_t count = 0;  ///< soundings that speak of the seabed
    bool doubtful = false;    ///< the cell holds more than seabed
  };

  explicit SurfaceEstimator(const SurfaceOptions& options = {});
  ~SurfaceEstimator();
  SurfaceEstimator(SurfaceEstimator&&) noexcept;
  SurfaceEstimator& operator=(SurfaceEstimator&&) noexcept;

  const SurfaceOptions& options() const { return options_; }
  void clear();

  /// The points of one ping or pair come one after the other.
  /// @throws core::OutputError if tiles cannot be put away, the disk being full
  void add(const MapPoint& point) { enter(point, 1); }
  /// The inverse of `add` for a point that was added: place, sigma and time must be the same.
  void remove(const MapPoint& point) { enter(point, -1); }

  /// Visits every cell that has a height, in no order. Soundings higher than `minDepth_m` below the water do not count.
  /// @return soundings and cells that gave none
  SurfaceStatistics forEachCell(double waterHeight_m, const std::function<void(const Cell&)>& visit) const;

  std::size_t tilesInMemory() const;
  std::size_t tileCount() const;

 private:
  void enter(const MapPoint& point, int sign);

  SurfaceOptions options_;
  std::unique_ptr<SurfaceTiles> tiles_;
  std::uint64_t soundings_ = 0, notFinite_ = 0;
};

}  // namespace s2s::map
