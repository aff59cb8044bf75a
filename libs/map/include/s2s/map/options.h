#pragma once

#include <cmath>
#include <cstdint>

#include "s2s/map/keyframes.h"
#include "s2s/map/surface_estimator.h"
#include "s2s/map/wall_estimator.h"

namespace s2s::map {

/// Where line-scan returns are put on their arcs.
enum class LineElevation : std::uint8_t {
  Zero = 0,     ///< in the imaging plane (the paper)
  Resolved = 1  ///< by evidence, see LineScanResolver
};

/// How data enters the map.
struct InsertionOptions {
  PoseInterpolation interpolation = PoseInterpolation::Odometry;
  LineElevation lineElevation = LineElevation::Resolved;
  /// One LiDAR point a voxel of this edge (in the odometry's frame); 0 keeps all.
  double lidarVoxel_m = 0.10;
  /// A voxel accepts a further point after this time, so that a place seen again later is mapped again and drift is
  /// not hidden; 0 thins each scan by itself.
  double lidarVoxelWindow_s = 30.0;
  double lidarMinRange_m = 0.5;  ///< nearer returns are the vessel's own; from the vehicle's origin
  double lidarMaxRange_m = 200.0;
  // Noise of LiDAR points for which the inserter gives none: sqrt(range² + (distance * angle)²).
  double lidarRangeSigma_m = 0.02;
  double lidarAngleSigma_rad = 0.001;
  /// Pings of the two sonars further apart than this are not paired for stereo when MRPT inserts them one by one.
  double stereoWindow_s = 0.10;
};

/// How line-scan returns find their place on the arc.
struct ResolverOptions {
  double cell_m = 0.25;              ///< edge of the seabed height grid's cells
  double wallCell_m = 0.5;           ///< edge of the cells in which walls are looked for
  double wallMinHeight_m = 0.75;     ///< points of a cell and its neighbours must span this height to make a wall
  double wallMaxThickness_m = 0.10;  ///< and lie this close to a vertical plane (standard deviation)
  int wallMinPoints = 12;
  /// LiDAR returns up to this height above the waterline tell of walls that go on below.
  double lidarWallBand_m = 2.5;
  double lidarWallRange_m = 20.0;    ///< and up to this distance from the vehicle: beyond, no sonar looks
  double gate = 3.0;                 ///< an arc meets a known surface within this many standard deviations
  double surfaceRoughness_m = 0.05;  ///< standard deviation added to every surface when an arc is compared with it
  int arcSteps = 17;                 ///< places tried along an arc
  double edgeSigma_rad = 0.5 * M_PI / 180.0;  ///< how sharp the edge of the aperture is
  /// How far the end of the horizontal sonar's aperture may be from the nominal one (standard deviation): the
  /// brightness of the bed decides, and the survey tells, see ApertureEnd. 0 believes the nominal end.
  double endSigma_rad = 2 * M_PI / 180;
  double relief_m = 0.03;         ///< unevenness of a surface within a footprint
  int freePings = 3;              ///< so many pings must agree that a place is free
  double freeMargin_m = 0.15;     ///< and it must lie this far in front of their returns
  double resolvedLength_m = 0.3;  ///< a shorter part of an arc counts as one place
};

struct LikelihoodOptions {
  double sigma_m = 0.10;       ///< standard deviation of a point's distance to the map
  double maxDistance_m = 1.0;  ///< greater distances count as this one
  int decimation = 10;         ///< uses one of so many points of an observation
  double mapVoxel_m = 0.20;    ///< the LiDAR layer is thinned to this for the nearest-neighbour search
};

struct ViewOptions {
  int maxPoints = 5'000'000;  ///< of all layers together; more are thinned evenly
  double pointSize = 2.0;     ///< pixels
};

struct MapOptions {
  InsertionOptions insertion;
  ResolverOptions resolver;
  LikelihoodOptions likelihood;
  ViewOptions view;
  // Not streamed with the map: whoever reads it chooses.
  SurfaceOptions surface;
  WallSurfaceOptions walls;
  double waterline_m = 0;  ///< height of the water surface in the vehicle frame at rest
};

}  // namespace s2s::map
