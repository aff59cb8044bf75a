#include "s2s/graph/options_table.h"

namespace s2s::graph {

core::OptionTable optionTable(KeyframePolicyOptions& o) {
  core::OptionTable table;
  table.add("distance_m", o.distance_m, "a keyframe each so many metres", core::positive())
      .addDegrees("rotation_deg", o.rotation_rad, "or after turning so far", core::positive());
  return table;
}

core::OptionTable optionTable(LoopSearchOptions& o) {
  core::OptionTable table;
  table.add("enabled", o.enabled, "look for loop closures")
      .add("min_travel_m", o.minTravel_m, "path between the keyframes of a closure", core::positive())
      .add("radius_m", o.radius_m, "distance of estimated positions that may see the same place", core::positive())
      .add("search_every_m", o.searchEvery_m, "path between two searches", core::atLeast(0))
      .add("proximity_candidates", o.proximityCandidates, "passes by estimated position tried a search",
           core::atLeast(0))
      .add("descriptor_candidates", o.descriptorCandidates, "places that look alike tried a search", core::atLeast(0))
      .add("submap_m", o.submap_m, "path on either side of a candidate that its submap covers", core::atLeast(0));
  return table;
}

core::OptionTable optionTable(ScanContextOptions& o) {
  core::OptionTable table;
  table.add("rings", o.rings, "rings of the place descriptor", {1, 1000})
      .add("sectors", o.sectors, "sectors of the place descriptor", {4, 1000})
      .add("max_range_m", o.maxRange_m, "radius of the place descriptor", core::positive())
      .add("min_height_m", o.minHeight_m, "lowest height counted, from the vehicle's origin")
      .add("max_distance", o.maxDistance, "largest difference of places that look alike", {0, 1})
      .add("shortlist", o.shortlist, "places compared in full a search", core::atLeast(1));
  return table;
}

core::OptionTable optionTable(RegistrationOptions& o) {
  core::OptionTable table;
  table.add("voxel_m", o.voxel_m, "thinning of submaps", core::positive())
      .add("normal_neighbours", o.normalNeighbours, "points that define a plane", {5, 100})
      .add("coarse_partner_m", o.coarsePartner_m, "largest distance of partners at first", core::positive())
      .add("fine_partner_m", o.finePartner_m, "largest distance of partners at last", core::positive())
      .add("max_iterations", o.maxIterations, "iterations of ICP", core::atLeast(1))
      .add("residual_scale_m", o.residualScale_m, "width of the robust weight", core::positive())
      .add("min_overlap", o.minOverlap, "share of points that must find a partner", {0, 1})
      .add("max_rmse_m", o.maxRmse_m, "largest RMS point-to-plane distance", core::positive())
      .add("degeneracy_ratio", o.degeneracyRatio, "times the information that noisy normals pretend is taken off",
           core::atLeast(0))
      .add("max_degenerate", o.maxDegenerate, "directions of six that may stay unknown", {0, 5})
      .add("correlated_points", o.correlatedPoints, "points that count as one measurement", core::atLeast(1))
      .add("floor_translation_m", o.floorTranslation_m, "smallest standard deviation of a closure", core::positive())
      .addDegrees("floor_rotation_deg", o.floorRotation_rad, "smallest standard deviation of its rotation",
                  core::positive());
  return table;
}

core::OptionTable optionTable(ConsistencyOptions& o) {
  core::OptionTable table;
  table.add("chi2", o.chi2, "gate of the agreement tests, 6 degrees of freedom", core::positive())
      .add("min_support", o.minSupport,
           "closures between the same stretches of path that must agree before one is believed", core::atLeast(1))
      .add("stretch_m", o.stretch_m, "length of such a stretch", core::positive())
      .add("drift_translation_m", o.driftTranslation_m, "assumed drift of the odometry after 1 m, random walk",
           core::positive())
      .addDegrees("drift_rotation_deg", o.driftRotation_rad, "and of its rotation", core::positive());
  return table;
}

core::OptionTable optionTable(GnssOptions& o) {
  core::OptionTable table;
  table.add("enabled", o.enabled, "let GNSS take part while it agrees with the map")
      .add("min_sigma_m", o.minSigma_m, "smallest standard deviation of a fix", core::positive())
      .add("min_spacing_m", o.minSpacing_m, "path between two fixes that are used", core::atLeast(0))
      .add("min_track_m", o.minTrack_m, "extent of the track before GNSS is used", core::positive())
      .add("min_fixes", o.minFixes, "fixes before GNSS is used", core::atLeast(3))
      .add("drift_per_metre", o.driftPerMetre, "error of the map's shape per metre of track", core::atLeast(0))
      .add("gate", o.gate, "largest residual of a believed fix in standard deviations", core::positive())
      .add("correlation_s", o.correlation_s, "fixes within it count as one measurement", core::atLeast(0))
      .add("distrust_run", o.distrustRun, "successive unbelievable fixes after which GNSS is distrusted",
           core::atLeast(1))
      .add("distrust_share", o.distrustShare, "share of unbelievable fixes after which GNSS is distrusted", {0, 1})
      .add("loss_width", o.lossWidth, "width of the robust loss in standard deviations", core::positive());
  return table;
}

core::OptionTable optionTable(WaterlineOptions& o) {
  core::OptionTable table;
  table.add("enabled", o.enabled, "prior that the vessel floats at the water surface")
      .add("sigma_m", o.sigma_m, "heave and trim, standard deviation", core::positive())
      .add("drift_sigma_m", o.driftSigma_m, "change of the surface from one section to the next", core::positive())
      .add("section_s", o.section_s, "length of a section", core::positive())
      .add("loss_width", o.lossWidth, "width of the robust loss in standard deviations", core::positive())
      .add("give_up_share", o.giveUpShare, "share of keyframes off the surface after which the prior is dropped",
           {0, 1});
  return table;
}

core::OptionTable optionTable(FalseClosureOptions& o) {
  core::OptionTable table;
  table.add("share", o.share, "to test robustness: share of the candidates that are made wrong; 0: none", {0, 0.9})
      .add("seed", o.seed, "of the wrong ones", core::atLeast(0))
      .add("repeated_shift_m", o.repeatedShift_m, "of every third wrong one, along x and y of the map");
  return table;
}

core::OptionTable optionTable(RelocationOptions& o) {
  core::OptionTable table;
  table
      .add("candidates", o.candidates, "places of the prior map registered a keyframe until one is found",
           core::atLeast(1))
      .add("max_distance", o.maxDistance, "largest difference of places that look alike", {0, 1})
      .add("shortlist", o.shortlist, "places compared in full", core::atLeast(1))
      .add("min_support", o.minSupport, "keyframes that must agree before the place counts as found", core::atLeast(2))
      .add("search_every_m", o.searchEvery_m, "path between two registrations afterwards", core::positive())
      .add("radius_m", o.radius_m, "distance from the prior map's keyframes within which they are made",
           core::positive());
  return table;
}

core::OptionTable optionTable(SonarFactorOptions& o) {
  AcousticRegistrationOptions& r = o.registration;
  core::OptionTable table;
  table.add("enabled", o.enabled, "factors between places that the sonars saw twice")
      .add("submap_m", o.submap_m, "path that makes up an acoustic submap", core::positive())
      .add("max_submap_s", o.maxSubmap_s, "a slower vessel's submap ends after this", core::positive())
      .add("min_travel_m", o.minTravel_m, "path between the two submaps of a factor", core::positive())
      .add("radius_m", o.radius_m, "largest distance of two submaps", core::positive())
      .add("cell_m", o.cell_m, "edge of the cells in which overlap is measured", core::positive())
      .add("min_overlap_m2", o.minOverlap_m2, "smallest common area", core::positive())
      .add("passes", o.passes, "earlier passes that a submap is registered to", core::atLeast(1))
      .add("joined_m", o.joined_m, "path on either side of an earlier submap that joins it as target", core::atLeast(0))
      .add("correlated_factors", o.correlatedFactors, "neighbouring factors that count as one", core::atLeast(1))
      .add("voxel_m", r.voxel_m, "thinning of the submaps", core::positive())
      .add("normal_neighbours", r.normalNeighbours, "points that define a plane", {5, 100})
      .add("coarse_partner_m", r.coarsePartner_m, "largest distance of partners at first", core::positive())
      .add("fine_partner_m", r.finePartner_m, "largest distance of partners at last", core::positive())
      .add("max_iterations", r.maxIterations, "iterations of the registration", core::atLeast(1))
      .add("loss_width", r.lossWidth, "width of the registration's robust weight in standard deviations",
           core::positive())
      .add("least_sigma_m", r.leastSigma_m, "no point is believed better than this", core::positive())
      .add("min_points", r.minPoints, "thinned points in common", core::atLeast(10))
      .add("min_overlap", r.minOverlap, "share of these that must find a partner", {0, 1})
      .add("max_chi2", r.maxChi2, "largest mean square of the residuals over their variances", core::positive())
      .add("degeneracy_ratio", r.degeneracyRatio, "times the information that noisy normals pretend is taken off",
           core::atLeast(0))
      .add("max_degenerate", r.maxDegenerate, "directions of six that may stay unknown; a flat seabed hides three",
           {0, 5})
      .add("correlated_points", r.correlatedPoints, "points that count as one measurement", core::atLeast(1))
      .add("floor_horizontal_m", r.floorHorizontal_m, "smallest standard deviation of a factor along x and y",
           core::positive())
      .add("floor_height_m", r.floorHeight_m, "and in height", core::positive())
      .addDegrees("floor_tilt_deg", r.floorTilt_rad, "and of its roll and pitch", core::positive())
      .addDegrees("floor_yaw_deg", r.floorYaw_rad, "and of its heading", core::positive())
      .add("start_spacing_m", r.startSpacing_m, "distance of the starts tried where the odometry leaves room",
           core::positive())
      .add("ambiguous_ratio", r.ambiguousRatio, "a second fit with less than this times the best one's cost is as good",
           core::atLeast(1));
  return table;
}

core::OptionTable optionTable(OptimizerOptions& o) {
  core::OptionTable table;
  table.add("max_iterations", o.maxIterations, "iterations of the optimiser", core::atLeast(1))
      .add("cost_tolerance", o.costTolerance, "smallest relative decrease of the cost", core::positive())
      .add("threads", o.threads, "threads of the optimiser", core::atLeast(1));
  return table;
}

core::OptionTable optionTable(GraphSlamOptions& o) {
  core::OptionTable table;
  table.add("cloud_voxel_m", o.cloudVoxel_m, "thinning of the clouds kept for loop closures", core::positive())
      .add("cloud_points", o.cloudPoints, "largest size of such a cloud", core::atLeast(100))
      .add("closure_loss_width", o.closureLossWidth, "width of the closures' robust loss in standard deviations",
           core::positive())
      .add("optimize_at_sigma", o.optimizeAt_sigma, "optimise when a new closure is so far off", core::atLeast(0))
      .add("optimize_at_count", o.optimizeAtCount, "or so many wait", core::atLeast(1))
      .add("use_gravity", o.useGravity, "hold roll and pitch by gravity")
      .add("gravity_correlation_s", o.gravityCorrelation_s, "keyframes within it count as one measurement of gravity",
           core::atLeast(0))
      .addDegrees("gravity_floor_deg", o.gravityFloor_rad, "smallest standard deviation of such a measurement",
                  core::positive());
  return table;
}

std::vector<std::pair<std::string, core::OptionTable>> optionSections(GraphSlamOptions& o, const std::string& prefix) {
  std::vector<std::pair<std::string, core::OptionTable>> sections;
  sections.emplace_back(prefix, optionTable(o));
  sections.emplace_back(prefix + ".keyframes", optionTable(o.keyframes));
  sections.emplace_back(prefix + ".loops", optionTable(o.loops));
  sections.emplace_back(prefix + ".places", optionTable(o.places));
  sections.emplace_back(prefix + ".registration", optionTable(o.registration));
  sections.emplace_back(prefix + ".consistency", optionTable(o.consistency));
  sections.emplace_back(prefix + ".optimizer", optionTable(o.optimizer));
  sections.emplace_back(prefix + ".gnss", optionTable(o.gnss));
  sections.emplace_back(prefix + ".waterline", optionTable(o.waterline));
  sections.emplace_back(prefix + ".relocation", optionTable(o.relocation));
  sections.emplace_back(prefix + ".sonar", optionTable(o.sonar));
  sections.emplace_back(prefix + ".false_closures", optionTable(o.falseClosures));
  return sections;
}

}  // namespace s2s::graph
