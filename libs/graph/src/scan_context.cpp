#include "s2s/graph/scan_context.h"

#include <algorithm>

namespace s2s::graph {

Eigen::Matrix3d levelRotation(const core::Isometry& T_map_vehicle) {
  const Eigen::Matrix3d R = T_map_vehicle.linear();
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  return Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R;
}

PlaceDatabase::Descriptor PlaceDatabase::describe(const Cloud& cloud_vehicle,
                                                  const Eigen::Matrix3d& R_level_vehicle) const {
  Descriptor cells = Descriptor::Zero(options_.rings, options_.sectors);
  const Eigen::Matrix3f R = R_level_vehicle.cast<float>();
  for (const auto& point_vehicle : cloud_vehicle) {
    const Eigen::Vector3f point = R * point_vehicle;
    const double range_m = std::hypot(point.x(), point.y());
    const double height_m = point.z() - options_.minHeight_m;
    if (range_m >= options_.maxRange_m || height_m <= 0) continue;
    const double turn = (std::atan2(point.y(), point.x()) + M_PI) / (2 * M_PI);
    const int ring = static_cast<int>(range_m / options_.maxRange_m * options_.rings);
    const int sector = std::min(static_cast<int>(turn * options_.sectors), options_.sectors - 1);
    cells(ring, sector) = std::max(cells(ring, sector), static_cast<float>(height_m));
  }
  return cells;
}

void PlaceDatabase::add(const Cloud& cloud_vehicle, const Eigen::Matrix3d& R_level_vehicle) {
  descriptors_.push_back(describe(cloud_vehicle, R_level_vehicle));
  ringKeys_.emplace_back(descriptors_.back().rowwise().mean());
}

PlaceMatch PlaceDatabase::compare(const Descriptor& query, int place) const {
  const Descriptor& a = descriptors_[place];
  const Descriptor& b = query;
  const Eigen::VectorXf normsA = a.colwise().norm(), normsB = b.colwise().norm();
  const int sectors = options_.sectors;
  PlaceMatch best;
  best.place = place;
  best.distance = 2;
  for (int shift = 0; shift < sectors; ++shift) {
    double similarity = 0;
    int columns = 0;
    for (int s = 0; s < sectors; ++s) {
      // A vehicle turned by +shift sectors sees the same thing shift sectors lower.
      const int sB = (s - shift + sectors) % sectors;
      if (normsA[s] == 0 && normsB[sB] == 0) continue;
      ++columns;
      if (normsA[s] > 0 && normsB[sB] > 0) similarity += a.col(s).dot(b.col(sB)) / (normsA[s] * normsB[sB]);
    }
    const double distance = columns > 0 ? 1 - similarity / columns : 1;
    if (distance >= best.distance) continue;
    best.distance = distance;
    best.yaw_rad = std::remainder(shift * 2 * M_PI / sectors, 2 * M_PI);
  }
  return best;
}

std::vector<PlaceMatch> PlaceDatabase::find(int query, int count, int limit) const {
  return search({descriptors_[query], ringKeys_[query], count, options_.shortlist, options_.maxDistance, limit});
}

std::vector<PlaceMatch> PlaceDatabase::findLike(const Cloud& cloud_vehicle, const Eigen::Matrix3d& R_level_vehicle,
                                                int shortlist, double maxDistance, int limit) const {
  const Descriptor cells = describe(cloud_vehicle, R_level_vehicle);
  const Eigen::VectorXf ringKey = cells.rowwise().mean();
  return search({cells, ringKey, size(), shortlist, maxDistance, limit});
}

std::vector<PlaceMatch> PlaceDatabase::search(const Search& query) const {
  std::vector<std::pair<float, int>> nearest;
  nearest.reserve(static_cast<std::size_t>(std::max(0, query.count)));
  for (int place = 0; place < query.count; ++place)
    nearest.emplace_back((ringKeys_[place] - query.ringKey).squaredNorm(), place);
  const auto shortlist = std::min<std::size_t>(nearest.size(), static_cast<std::size_t>(query.shortlist));
  std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(shortlist), nearest.end());

  std::vector<PlaceMatch> matches;
  for (std::size_t n = 0; n < shortlist; ++n) {
    const PlaceMatch match = compare(query.cells, nearest[n].second);
    if (match.distance <= query.maxDistance) matches.push_back(match);
  }
  std::sort(matches.begin(), matches.end(), [](const PlaceMatch& a, const PlaceMatch& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.place < b.place;
  });
  const auto limit = static_cast<std::size_t>(query.limit);
  if (matches.size() > limit) matches.resize(limit);
  return matches;
}

}  // namespace s2s::graph
