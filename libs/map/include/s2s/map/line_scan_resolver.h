#pragma once

#include <Eigen/Core>

#include "s2s/core/transform.h"
#include "s2s/map/options.h"
#include "s2s/map/scan.h"
#include "s2s/map/surface_evidence.h"

namespace s2s::map {

/// Decides where on its arc a leading-edge return lies.
///
/// A return at range r and bearing b came from somewhere on the arc of all elevations within the aperture, and
/// everything nearer was free: the surface touches the arc from outside. So the arc is compared with the surfaces known
/// there, and the return is put where the gap between arc and surface is least, if that gap is zero within its
/// uncertainty. An arc that cuts through a known seabed (its nearest part gave no echo above the threshold) is put
/// where it crosses. If no known surface is met, the lowest point of the arc is taken: a level seabed is met there
/// first. That is the lower edge of the aperture for a horizontal sonar looking down, and the imaging plane for a
/// vertical one.
///
/// The standard deviation is that of range and bearing, of the surface, and along the arc that of the elevations that
/// would have done as well: all of the aperture if nothing is known.
class LineScanResolver {
 public:
  /// Drops all evidence.
  void reset(const ResolverOptions& options);
  const ResolverOptions& options() const { return options_; }

  /// Points on seabed and walls with their standard deviations, in the map's frame (stereo, vertical profile).
  void addSonarEvidence(const Eigen::Vector3d& p_map, double sigma_m) { evidence_.addSonarPoint(p_map, sigma_m); }
  /// LiDAR points just above the water: walls only.
  void addWallEvidence(const Eigen::Vector3d& p_map) { evidence_.addWallPoint(p_map); }
  /// A resolved ping of the vertical sonar: its returns as a profile of the seabed below and the walls ahead.
  void addProfile(const StoredLineScan& scan, const core::Isometry& T_map_vehicle);

  /// Sets elevation, source and sigma of each return. Without evidence each gets the lowest point of its arc.
  void resolve(StoredLineScan& scan, const core::Isometry& T_map_vehicle) const;
  /// Sets all elevations to zero with the sigma of the whole aperture (the paper).
  static void setZero(StoredLineScan& scan);

  const SurfaceEvidence& evidence() const { return evidence_; }

 private:
  ResolverOptions options_;
  SurfaceEvidence evidence_;
};

}  // namespace s2s::map
