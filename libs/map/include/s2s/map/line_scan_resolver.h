#pragma once

#include <Eigen/Core>

#include <array>

#include "s2s/core/transform.h"
#include "s2s/map/aperture_end.h"
#include "s2s/map/free_space.h"
#include "s2s/map/options.h"
#include "s2s/map/scan.h"
#include "s2s/map/sparse_grid.h"
#include "s2s/map/surface_evidence.h"

namespace s2s::map {

/// Decides where on its arc a return lies.
///
/// A first return at range r and bearing b came from somewhere on the arc of all elevations within the aperture, and
/// everything nearer was free: the surface touches the arc from outside. In this order:
/// 1. Where the gap between the arc and a known surface, the seabed by the other evidence or a wall, is least, if that
///    gap is zero within its uncertainty. An arc that cuts through a known seabed (its nearest part gave no echo above
///    the threshold) is put where it crosses.
/// 2. The lowest point of the arc, where a level seabed is met first, if arcs of the same sonar from other poses have
///    met it there too. That is the lower edge of the aperture for a horizontal sonar looking down, and the imaging
///    plane for a vertical one.
/// 3. What is left of the arc when the places that other pings prove to be free are taken away. If it is short, it is
///    the place; else the return is ambiguous, and its interval is the length of what is left.
///
/// For a return behind the first the space in front is not free; it is a point only if a known wall explains it.
///
/// Where the aperture of the horizontal sonar ends is learnt from the survey (`observeEnds`).
///
/// The standard deviation is that of the distance from the surface: of range and bearing, and along the arc of the
/// elevations that would have done as well. Where the arc touches the surface inside the aperture it is tangent to it:
/// a wrong elevation then moves the point along the surface.
class LineScanResolver {
 public:
  /// Drops all evidence.
  void reset(const ResolverOptions& options);
  const ResolverOptions& options() const { return options_; }

  /// A stereo point: seabed and walls.
  void addStereoPoint(const Eigen::Vector3d& p_map, double sigma_m);
  /// A LiDAR point just above the water: walls only.
  void addWallPoint(const Eigen::Vector3d& p_map) { walls_.addWallPoint(p_map); }
  /// The wall known at a place, see SurfaceEvidence.
  std::optional<SurfaceEvidence::Wall> wallNear(double x_m, double y_m) const { return walls_.wallNear(x_m, y_m); }
  /// Learns from a ping of the horizontal sonar where its aperture ends: where the seabed is known from stereo and the
  /// vertical sonar. The ends of the vertical sonar lie at its sides, which hardly meet anything first: they stay.
  void observeEnds(const StoredLineScan& scan, const core::Isometry& T_map_vehicle);
  /// The ends of the horizontal sonar's aperture, at negative and at positive elevations.
  const std::array<ApertureEnd, 2>& ends() const { return ends_; }
  /// A resolved ping. What one sonar saw is evidence for the other, never for itself: it would only agree with itself.
  void addLineScan(const StoredLineScan& scan, const core::Isometry& T_map_vehicle);

  /// Sets elevation, source, sigma and interval of each return. Without evidence each gets the lowest point of its arc.
  /// @param pass `First`: evidence is still to come, so that what is free, the dearest question, is not asked
  enum class Pass { First, Final };
  void resolve(StoredLineScan& scan, const core::Isometry& T_map_vehicle, Pass pass = Pass::Final) const;
  /// Sets all elevations to zero with the sigma of the whole aperture (the paper).
  static void setZero(StoredLineScan& scan);

 private:
  ResolverOptions options_;
  static constexpr double kEndCell_m = 8;

  SurfaceEvidence walls_;
  SurfaceEvidence profiles_;  // seabed by stereo and the vertical sonar, for the horizontal one
  SurfaceEvidence swaths_;    // seabed by stereo and the horizontal sonar, for the vertical one
  FreeSpace free_;
  using Ends = std::array<ApertureEnd, 2>;
  Ends ends_;
  SparseGrid<Ends> endsHere_{kEndCell_m};                     // by the pings taken in a cell and its neighbours
  Eigen::Vector3d lastObserved_m_ = Eigen::Vector3d::Zero();  // where the last ping was taken that told of the ends
};

}  // namespace s2s::map
