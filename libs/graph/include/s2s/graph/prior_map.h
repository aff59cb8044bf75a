#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "s2s/core/time.h"
#include "s2s/graph/cloud_registration.h"
#include "s2s/graph/loop_closure.h"
#include "s2s/graph/scan_context.h"

namespace s2s::graph {

/// Finding one's place in a map made before, without any idea where.
struct RelocationOptions {
  int candidates = 8;        ///< places registered for each keyframe until the place is found
  double maxDistance = 0.4;  ///< largest descriptor distance of such a place; the registration decides, not this
  int shortlist = 60;        ///< places compared in full
  /// Keyframes within a stretch (see ConsistencyOptions) whose registrations must agree with the odometry between them
  /// before the place counts as found.
  int minSupport = 4;
  double searchEvery_m = 2;  ///< path between two registrations once it is found
  double radius_m = 10;      ///< keyframes of the old map this near are registered against then
};

/// A keyframe of a map made before.
struct PriorKeyframe {
  core::Isometry T_prior_vehicle = core::Isometry::Identity();
  Cloud cloud_vehicle;
};

/// A map made before, as keyframes that can be recognised and registered against.
class PriorMap {
 public:
  /// @param submap_m keyframes this near to one make up the submap around it
  PriorMap(std::vector<PriorKeyframe> keyframes, const ScanContextOptions& places,
           const RegistrationOptions& registration, double submap_m);

  std::size_t size() const { return keyframes_.size(); }

  /// Poses T_prior_vehicle at places that look like this one, best first.
  std::vector<core::Isometry> placesLike(const Cloud& cloud_vehicle, const core::Isometry& T_level,
                                         const RelocationOptions& options) const;
  /// Distance of the nearest keyframe's position.
  double distanceTo_m(const Eigen::Vector3d& p_prior) const;
  /// Registers a cloud against the submap of the keyframe nearest to the guess. In the result, T_from_to is
  /// T_prior_vehicle, and the status is pending if the clouds fit.
  LoopClosure registerAt(const core::Isometry& T_prior_vehicle, const Cloud& cloud_vehicle);

 private:
  int nearest(const Eigen::Vector3d& p_prior) const;
  const RegistrationTarget& submapAround(int keyframe);

  std::vector<PriorKeyframe> keyframes_;
  PlaceDatabase places_;
  RegistrationOptions registration_;
  double submap_m_;
  std::map<int, std::unique_ptr<RegistrationTarget>> submaps_;  ///< the last few, by keyframe
};

/// How the search for the place in the prior map went.
struct RelocationReport {
  bool wanted = false;           ///< a prior map was given
  bool located = false;          ///< and the survey's place in it found
  core::TimeNs locatedTime = 0;  ///< time of the keyframe that settled it
  int registered = 0;            ///< keyframes registered against it after that
  int believed = 0;              ///< of all registrations, those that hold the map now
};

}  // namespace s2s::graph
