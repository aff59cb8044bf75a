#pragma once

#include <vector>

#include "s2s/graph/cloud.h"

namespace s2s::graph {

/// Place descriptor after Kim and Kim, "Scan Context" (IROS 2018): the highest point in each cell of a polar grid
/// around the vehicle, and the rings' means as a key that does not depend on the heading.
struct ScanContextOptions {
  int rings = 20;
  int sectors = 60;
  double maxRange_m = 60;
  double minHeight_m = -2;    ///< lowest height counted, relative to the vehicle
  double maxDistance = 0.25;  ///< largest descriptor distance (0 alike, 1 nothing in common) of a match
  int shortlist = 10;         ///< places compared in full
};

struct PlaceMatch {
  int place = 0;
  double distance = 1;
  double yaw_rad = 0;  ///< heading of the query's vehicle in the place's vehicle frame
};

class PlaceDatabase {
 public:
  explicit PlaceDatabase(const ScanContextOptions& options) : options_(options) {}

  /// Adds the next place; its number is the count of places before it.
  /// @param R_level_vehicle turns the vehicle frame's up onto the vertical (roll and pitch; heading as the vehicle's)
  void add(const Cloud& cloud_vehicle, const Eigen::Matrix3d& R_level_vehicle);

  int size() const { return static_cast<int>(descriptors_.size()); }

  /// Places among the first `count` that look like place `query`, best first, at most `limit`.
  std::vector<PlaceMatch> find(int query, int count, int limit) const;

  /// Places that look like this cloud, best first; `shortlist` and `maxDistance` stand for those of the options.
  std::vector<PlaceMatch> findLike(const Cloud& cloud_vehicle, const Eigen::Matrix3d& R_level_vehicle, int shortlist,
                                   double maxDistance, int limit) const;

 private:
  using Descriptor = Eigen::MatrixXf;  ///< rings x sectors, heights above minHeight_m, 0 where empty
  struct Search {
    const Descriptor& cells;
    const Eigen::VectorXf& ringKey;
    int count, shortlist;
    double maxDistance;
    int limit;
  };
  Descriptor describe(const Cloud& cloud_vehicle, const Eigen::Matrix3d& R_level_vehicle) const;
  std::vector<PlaceMatch> search(const Search& query) const;
  PlaceMatch compare(const Descriptor& query, int place) const;

  ScanContextOptions options_;
  std::vector<Descriptor> descriptors_;
  std::vector<Eigen::VectorXf> ringKeys_;
};

/// Rotation that levels a vehicle: roll and pitch of T_map_vehicle without its heading.
Eigen::Matrix3d levelRotation(const core::Isometry& T_map_vehicle);

}  // namespace s2s::graph
