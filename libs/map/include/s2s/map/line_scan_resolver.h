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
/// The standard deviation is that of range and bearing, and along the arc that of the elevations that would have done
/// as well: all of the aperture if nothing is known. Where the arc touches a known surface inside the aperture it is
/// tangent to it: a wrong elevation moves the point along the surface, so there it is that of the distance from the
/// surface.
class LineScanResolver {
 public:
  /// Drops all evidence.
  void reset(const ResolverOptions& options);
  const ResolverOptions& options() const { return options_; }

  /// A stereo point: seabed and walls.
  void addStereoPoint(const Eigen::Vector3d& p_map, double sigma_m);
  /// A LiDAR point just above the water: walls only.
  void addWallPoint(const Eigen::Vector3d& p_map) { walls_.addWallPoint(p_map); }
  /// A resolved ping. What one sonar saw is evidence for the other, never for itself: it would only agree with itself.
  void addLineScan(const StoredLineScan& scan, const core::Isometry& T_map_vehicle);

  /// Sets elevation, source and sigma of each return. Without evidence each gets the lowest point of its arc.
  void resolve(StoredLineScan& scan, const core::Isometry& T_map_vehicle) const;
  /// Sets all elevations to zero with the sigma of the whole aperture (the paper).
  static void setZero(StoredLineScan& scan);

 private:
  ResolverOptions options_;
  SurfaceEvidence walls_;
  SurfaceEvidence profiles_;  // seabed by stereo and the vertical sonar, for the horizontal one
  SurfaceEvidence swaths_;    // seabed by stereo and the horizontal sonar, for the vertical one
};

}  // namespace s2s::map
