#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "s2s/map/map_point.h"
#include "s2s/products/height_grid.h"

namespace s2s::products {

struct SeabedGridOptions {
  double cell_m = 0.5;
  int minPoints = 3;               ///< soundings a cell needs
  double minDepth_m = 0.3;         ///< soundings nearer to the water surface are not used
  double flatSpread_m = 0.6;       ///< a cell whose soundings span more than this holds more than seabed
  double window_m = 0.4;           ///< height of the layer in which the seabed of such a cell is sought
  double minSeabedShare = 0.25;    ///< share of such a cell's weight that the layer must hold, else it is a wall
  double maxStep_m = 1.0;          ///< a cell that differs more from its neighbours' median is no seabed
  double maxDoubtfulStep_m = 0.4;  ///< the same for a cell that holds more than seabed
  double sigmaFloor_m = 0.02;      ///< smallest standard deviation that a single sounding is believed to have
  int maxCells = 100'000'000;      ///< a larger grid is refused
};

/// What became of the soundings and cells.
struct SeabedGridStatistics {
  std::uint64_t soundings = 0;   ///< offered, of the sonar layers
  std::uint64_t tooShallow = 0;  ///< of these: above `waterHeight_m - minDepth_m`
  std::uint64_t notFinite = 0;
  std::uint64_t cells = 0;      ///< with a height
  std::uint64_t fewPoints = 0;  ///< cells with fewer than `minPoints`
  std::uint64_t walls = 0;      ///< cells that hold nothing but wall
  std::uint64_t steps = 0;      ///< cells that disagreed with their neighbours
  double area_m2 = 0;
  double minHeight_m = 0, maxHeight_m = 0;
};

/// Grids the seabed from the soundings of the sonar layers (stereo, both line-scans); LiDAR points are passed over.
///
/// Each cell keeps a histogram of its soundings' heights (1 cm), so memory follows the area and not the number of
/// soundings. The height is the median weighted by 1/sigma². Where a cell spans more than `flatSpread_m`, as at a quay
/// wall, it is the weighted median inside the lowest layer of `window_m` that is at least half as dense as the densest:
/// neither the wall above nor a few false echoes below move it; it must then agree with its neighbours more closely.
///
/// The stated sigma is sqrt((v + m s²) / (1 + m)): v the weighted mean of the soundings' own variances, s the scatter
/// about the median (1.4826 MAD), m the pings in the cell. So what the soundings claim counts as one ping, and how far
/// the pings agree decides the more of them there are: an unresolved line-scan claims its whole arc, though the seabed
/// it shows may repeat to centimetres, and a precise one may be worse than it claims. It is a single ping's sigma and
/// not divided by their number, since mounting, pose and elevation errors are common to neighbouring pings.
class SeabedGridder {
 public:
  /// @param waterHeight_m height of the water surface in the map frame
  SeabedGridder(const SeabedGridOptions& options, double waterHeight_m);

  void add(const map::MapPoint& point);

  /// The grid of everything added so far; it may have no cells.
  /// @throws core::OutputError if it would have more than `maxCells`
  HeightGrid grid();
  const SeabedGridStatistics& statistics() const { return statistics_; }

 private:
  struct Bin {
    int height_cm = 0;
    std::uint32_t count = 0;
    double weight = 0;          ///< sum of 1/sigma²
    double weightedHeight = 0;  ///< sum of height/sigma²
  };
  using Bins = std::vector<Bin>;  ///< in order of height
  struct Cell {
    Bins bins;
    std::uint32_t pings = 0;  ///< changes of the soundings' time: they come ping by ping
    core::TimeNs lastTime = 0;
  };
  struct Estimate {
    double height_m = 0, sigma_m = 0;
    std::uint32_t count = 0;
    bool doubtful = false;  ///< the cell holds more than seabed
  };
  enum class Verdict { Seabed, FewPoints, Wall };

  Verdict estimate(const Cell& cell, Estimate& result) const;
  Bins seabedLayer(const Bins& cell) const;
  void removeSteps(HeightGrid& grid, const std::vector<bool>& doubtful);

  SeabedGridOptions options_;
  double ceiling_m_;
  std::unordered_map<std::uint64_t, Cell> cells_;
  SeabedGridStatistics statistics_;
};

}  // namespace s2s::products
