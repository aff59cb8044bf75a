#include "s2s/calib/options_table.h"

namespace s2s::calib {

core::OptionTable optionTable(CalibrationOptions& o) {
  core::OptionTable table;
  table.add("max_echoes", o.maxEchoes, "Pings are thinned out to stay below so many echoes", {1000, 1e7});
  table.addDegrees("max_bearing_deg", o.maxBearing_rad, "Beams further out are not used", {1, 89});
  table.addDegrees("far_edge_bearing_deg", o.farEdgeBearing_rad, "Far edges further out are not used", {0, 89});
  table.add("cell_m", o.cell_m, "Grid of the seabed's heights", {0.05, 5});
  table.add("roughness_m", o.roughness_m, "Standard deviation of the second difference of neighbouring heights",
            {1e-4, 10});
  table.add("min_cell_echoes", o.minCellEchoes, "Cells with fewer echoes are left out", {1, 1000});
  table.add("rounds", o.rounds, "Rounds of association and estimation", {1, 100});
  table.add("first_gate_m", o.firstGate_m, "Echoes further from the seabed are left out, first round", {0.01, 10});
  table.add("last_gate_m", o.lastGate_m, "The same, last round", {0.01, 10});
  table.add("loss_width", o.lossWidth, "Width of Cauchy's loss, in standard deviations", {0.1, 100});
  table.add("common_share", o.commonShare, "Share of the ranges' spread that is common to all echoes of a kind",
            {0.001, 1});
  table.add("sound_speed_common_mps", o.soundSpeedCommon_mps, "Error of the sound speed that no echo shows", {0, 100});
  table.add("time_common_share", o.timeCommonShare, "The same where time offsets are told", {0.001, 1});
  table.add("position_sigma_m", o.positionSigma_m, "How well mountings are known beforehand", core::positive());
  table.addDegrees("rotation_sigma_deg", o.rotationSigma_rad, "How well mountings are known beforehand",
                   core::positive());
  table.add("time_sigma_s", o.timeSigma_s, "How well time offsets are known beforehand", core::positive());
  table.add("sound_speed_sigma_mps", o.soundSpeedSigma_mps, "How well the sound speed is known beforehand",
            core::positive());
  table.addDegrees("aperture_sigma_deg", o.apertureSigma_rad, "How well the aperture's edges are known",
                   core::positive());
  table.addDegrees("aperture_asymmetry_sigma_deg", o.apertureAsymmetrySigma_rad,
                   "How much the aperture's two edges may differ", core::positive());
  table.addDegrees("aperture_bend_sigma_deg", o.apertureBendSigma_rad,
                   "How much the aperture's edges may change from the fan's centre to a radian", core::positive());
  table.add("weak_share", o.weakShare,
            "Directions known worse than this share of what was known beforehand stay nominal", {0.01, 1});
  table.add("range_sigma_m", o.rangeSigma_m, "How well a constant error of all ranges is known", core::positive());
  table.add("range_bearing_sigma_m", o.rangeBearingSigma_m,
            "How well an error of ranges that grows with bearing is known, at a radian", core::positive());
  table.add("range_scale_sigma", o.rangeScaleSigma, "How well an error of ranges that grows with range is known",
            core::positive());
  table.add("position_limit_m", o.positionLimit_m, "Known better than this it counts as observable", core::positive());
  table.addDegrees("rotation_limit_deg", o.rotationLimit_rad, "Known better than this it counts as observable",
                   core::positive());
  table.add("time_limit_s", o.timeLimit_s, "Known better than this it counts as observable", core::positive());
  table.add("sound_speed_limit_mps", o.soundSpeedLimit_mps, "Known better than this it counts as observable",
            core::positive());
  table.add("block_s", o.block_s, "Errors within such a time count as correlated", {0.1, 1e4});
  return table;
}

core::OptionTable optionTable(ApertureOptions& o) {
  core::OptionTable table;
  table.add("enabled", o.enabled, "Both ends of the aperture tell the horizontal sonar's turn across its plane");
  table.add("ping_step", o.pingStep, "One ping in so many is looked at", {1, 1000});
  table.add("beam_step", o.beamStep, "One group of beams in so many beams is looked at", {1, 1000});
  table.add("beams_averaged", o.beamsAveraged, "Beams of a group", {1, 99});
  table.add("min_range_m", o.minRange_m, "Nearer bins hold the ring-down", {0, 1000});
  table.add("stack_s", o.stack_s, "Pings of such a time are averaged into one profile", {0.1, 1000});
  table.addDegrees("sector_deg", o.sector_rad, "Beams of such a sector are averaged into one profile", {1, 180});
  table.addDegrees("max_bearing_deg", o.maxBearing_rad, "Beams further out are not used", {1, 89});
  table.addDegrees("step_deg", o.step_rad, "Step of elevation of a profile", {0.02, 5});
  table.addDegrees("beyond_deg", o.beyond_rad, "Profiles reach so far to either side of an end", {1, 45});
  table.addDegrees("ramp_deg", o.ramp_rad, "Elevations nearer to an end tell neither level", {0.1, 45});
  table.addDegrees("level_deg", o.level_rad, "Elevations beyond those that tell the level on a side", {0.1, 45});
  table.add("min_profiles", o.minProfiles, "Groups of beams that make a profile at least", {1, 1e6});
  table.add("min_contrast", o.minContrast, "Least ratio of the level inside to that outside", {1, 1000});
  table.addDegrees("width_sigma_deg", o.widthSigma_rad, "How far both ends may lie beyond the nominal aperture",
                   core::positive());
  table.addDegrees("width_bend_sigma_deg", o.widthBendSigma_rad,
                   "The same, its change from the fan's centre to a radian", core::positive());
  table.addDegrees("axis_sigma_deg", o.axisSigma_rad, "How far their middle may lie off the imaging plane",
                   core::positive());
  return table;
}

core::OptionTable optionTable(WaterMirrorOptions& o) {
  core::OptionTable table;
  table.add("enabled", o.enabled, "Echoes by way of the water surface tell how deep the vertical sonar is");
  table.add("beam_step", o.beamStep, "One beam in so many is looked at", {1, 1000});
  table.add("reach_m", o.reach_m, "They are looked for so far from where they should be", {0.02, 0.5});
  table.add("min_strength", o.minStrength, "Least strength, as a share of the first echo", {0, 1});
  table.add("min_explained", o.minExplained, "Least share of what the first echo leaves unexplained", {0, 1});
  table.add("min_traces", o.minTraces, "Fewer first echoes tell nothing", {1, 1e7});
  table.add("sigma_m", o.sigma_m, "Standard deviation of the depth so found", core::positive());
  return table;
}

core::OptionTable optionTable(TextureOptions& o) {
  core::OptionTable table;
  table.add("enabled", o.enabled,
            "The bed's texture in pings from different places tells the horizontal sonar's mounting");
  table.add("min_range_m", o.minRange_m, "Nearer bins hold the ring-down", {0, 1000});
  table.add("band_level", o.bandLevel, "Share of a beam's strongest mean echo at which its band ends", {0.05, 1});
  table.add("mean_reach_m", o.meanReach_m, "A sample is held against the mean of so much range either way",
            core::positive());
  table.addDegrees("mean_reach_deg", o.meanReach_rad, "The same in bearing", {0.1, 45});
  table.add("aperture_share", o.apertureShare, "Elevations beyond this share of half the aperture are not used",
            {0.05, 1});
  table.add("group_s", o.group_s, "Pings of such a time are averaged into a picture of the bed", {0.01, 10});
  table.add("pixel_m", o.pixel_m, "Pixel of these pictures", {0.005, 1});
  table.add("tile_m", o.tile_m, "Side of the squares that are found again", {0.1, 20});
  table.add("fine_blur_m", o.fineBlur_m, "Finer texture is blurred", core::positive());
  table.add("coarse_blur_m", o.coarseBlur_m, "Coarser texture is taken off", core::positive());
  table.add("min_overlap", o.minOverlap, "Least share of a square that both pictures show", {0.05, 1});
  table.add("pairs_per_tile", o.pairsPerTile, "So many pairs of pictures of a square are compared", {1, 10000});
  table.add("min_gap_s", o.minGap_s, "Time between two pictures of a pair", {0, 1e4});
  table.add("min_correlation", o.minCorrelation, "Least correlation at the peak", {0, 1});
  table.add("min_distinctness", o.minDistinctness, "Least ratio of the peak to the next best one", {1, 100});
  table.add("tilt_sigma_m_per_rad", o.tiltSigma_mPerRad, "How much higher the bed may seem, growing with elevation",
            core::positive());
  table.add("first_reach_m", o.firstReach_m, "Displacements up to this are looked for, first round", {0.02, 5});
  table.add("last_reach_m", o.lastReach_m, "The same, last round", {0.02, 5});
  return table;
}

core::OptionTable optionTable(SwathOptions& o) {
  core::OptionTable table;
  table.add("beam_step", o.beamStep, "One beam in so many is looked at", {1, 1000});
  table.add("beams_averaged", o.beamsAveraged, "So many neighbouring beams are averaged", {1, 99});
  table.add("min_range_m", o.minRange_m, "Nearer bins hold the ring-down", {0, 1000});
  table.add("floor_quantile", o.floorQuantile, "Quantile of a row that is its noise floor", {0, 1});
  table.addDegrees("edge_window_deg", o.edgeWindow_rad, "Elevation: half the window in which an edge is refined",
                   {0.1, 45});
  table.add("min_length_m", o.minLength_m, "A shorter band is noise", {0, 100});
  table.add("min_contrast", o.minContrast, "Least summed excess over the threshold, in thresholds", {0, 1e6});
  return table;
}

}  // namespace s2s::calib
