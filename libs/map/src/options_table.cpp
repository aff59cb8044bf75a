#include "s2s/map/options_table.h"

namespace s2s::map {

core::OptionTable optionTable(InsertionOptions& o) {
  core::OptionTable table;
  table
      .addChoice(
          "interpolation", o.interpolation,
          {{"odometry", PoseInterpolation::Odometry}, {"constant_velocity", PoseInterpolation::ConstantVelocity}},
          "poses between keyframes: odometry (corrected by the keyframes around) or constant_velocity (the paper)")
      .addChoice("line_elevation", o.lineElevation,
                 {{"zero", LineElevation::Zero}, {"resolved", LineElevation::Resolved}},
                 "where line-scan returns lie across the aperture: zero (the paper) or resolved by evidence")
      .add("lidar_voxel_m", o.lidarVoxel_m, "one LiDAR point a voxel of this edge; 0 keeps all", core::atLeast(0))
      .add("lidar_voxel_window_s", o.lidarVoxelWindow_s,
           "a voxel accepts a further point after this time; 0 thins each sweep by itself", core::atLeast(0))
      .add("lidar_min_range_m", o.lidarMinRange_m, "nearer LiDAR returns are the vessel's own", core::atLeast(0))
      .add("lidar_max_range_m", o.lidarMaxRange_m, "farther LiDAR returns stay out of the map", core::positive())
      .add("lidar_range_sigma_m", o.lidarRangeSigma_m, "standard deviation of a LiDAR range", core::atLeast(0))
      .addDegrees("lidar_angle_sigma_deg", o.lidarAngleSigma_rad, "standard deviation of a LiDAR beam's direction",
                  core::Range{0, 10})
      .add("stereo_window_s", o.stereoWindow_s,
           "pings of the two sonars further apart are not paired (only when MRPT inserts them one by one)",
           core::atLeast(0));
  return table;
}

core::OptionTable optionTable(ResolverOptions& o) {
  core::OptionTable table;
  table.add("cell_m", o.cell_m, "edge of the cells of the seabed height grid", core::Range{0.02, 10})
      .add("wall_cell_m", o.wallCell_m, "edge of the cells in which walls are looked for", core::Range{0.05, 10})
      .add("wall_min_height_m", o.wallMinHeight_m, "height that the points of a wall's cell must span",
           core::positive())
      .add("wall_max_thickness_m", o.wallMaxThickness_m,
           "standard deviation of a wall's points about their vertical plane, at most", core::positive())
      .add("wall_min_points", o.wallMinPoints, "points that make a wall's cell", core::Range{3, 1e6})
      .add("lidar_wall_band_m", o.lidarWallBand_m,
           "LiDAR returns up to this height above the waterline tell of walls that go on below", core::atLeast(0))
      .add("lidar_wall_range_m", o.lidarWallRange_m, "and up to this distance from the vehicle", core::atLeast(0))
      .add("gate", o.gate, "an arc meets a known surface within this many standard deviations", core::positive())
      .add("surface_roughness_m", o.surfaceRoughness_m, "standard deviation added to every known surface",
           core::atLeast(1e-3))
      .add("arc_steps", o.arcSteps, "places tried along an arc", core::Range{3, 1001})
      .addDegrees("edge_sigma_deg", o.edgeSigma_rad, "how sharp the edge of an aperture is: standard deviation",
                  core::Range{0, 20})
      .addDegrees("end_sigma_deg", o.endSigma_rad,
                  "how far the end of the horizontal sonar's aperture may be from the nominal one, before the survey "
                  "tells: standard deviation; 0 believes the nominal end",
                  core::Range{0, 20})
      .add("relief_m", o.relief_m, "unevenness of a surface within a footprint: standard deviation", core::atLeast(0))
      .add("free_pings", o.freePings, "so many pings must agree that a place is free", core::Range{1, 1000})
      .add("free_margin_m", o.freeMargin_m, "a place is free if it lies this far in front of a ping's return",
           core::atLeast(0))
      .add("resolved_length_m", o.resolvedLength_m, "a shorter part of an arc that is left counts as one place",
           core::atLeast(0));
  return table;
}

core::OptionTable optionTable(LikelihoodOptions& o) {
  core::OptionTable table;
  table.add("sigma_m", o.sigma_m, "standard deviation of a point's distance to the map", core::positive())
      .add("max_distance_m", o.maxDistance_m, "greater distances count as this one", core::positive())
      .add("decimation", o.decimation, "uses one of so many points of an observation", core::Range{1, 1e6})
      .add("map_voxel_m", o.mapVoxel_m, "the LiDAR layer is thinned to this before it is searched", core::positive());
  return table;
}

core::OptionTable optionTable(ViewOptions& o) {
  core::OptionTable table;
  table.add("max_points", o.maxPoints, "points in the 3D view of all layers together", core::Range{1, 1e9})
      .add("point_size", o.pointSize, "pixels", core::positive());
  return table;
}

}  // namespace s2s::map
