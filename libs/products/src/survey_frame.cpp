#include "s2s/products/survey_frame.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace s2s::products {

SurveyFrame::SurveyFrame(const core::Trajectory& path, const CloudStatistics& statistics) {
  if (path.empty()) {
    const Eigen::AlignedBox3d box = statistics.box();
    if (box.isEmpty()) return;
    middle_m = box.center().head<2>();
    low_m = box.min().head<2>() - middle_m;
    high_m = box.max().head<2>() - middle_m;
    return;
  }
  Eigen::AlignedBox2d box;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& pose : path.poses()) mean += pose.T.translation().head<2>();
  mean /= static_cast<double>(path.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const auto& pose : path.poses()) {
    const Eigen::Vector2d d = pose.T.translation().head<2>() - mean;
    scatter += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter);
  along = solver.eigenvectors().col(1);
  if (along.x() < 0) along = -along;
  middle_m = mean;
  for (const auto& pose : path.poses()) box.extend(local(pose.T.translation()));
  const Eigen::Vector2d shift = box.center();
  middle_m = toMap(shift.x(), shift.y(), 0).head<2>();
  low_m = box.min() - shift;
  high_m = box.max() - shift;
}

void CrossSectionFinder::add(const map::MapPoint& point) {
  const double station = along_.dot(point.p_map.head<2>() - middle_m_);
  const double slab = std::floor(station / thickness_m_);
  if (!(std::abs(slab) < 1e9)) return;
  Counts& counts = slabs_[static_cast<std::int64_t>(slab)];
  ++(point.layer == map::Layer::Lidar ? counts.lidar : counts.sonar);
}

double CrossSectionFinder::station_m() const {
  double best = 0, station = 0;
  for (const auto& [slab, counts] : slabs_) {
    const double value = static_cast<double>(counts.lidar) * static_cast<double>(counts.sonar);
    const double here = (static_cast<double>(slab) + 0.5) * thickness_m_;
    // The order of the table is not defined: of equals the one nearer to the middle, then the larger.
    if (value > best || (value == best && value > 0 &&
                         std::make_pair(-std::abs(here), here) > std::make_pair(-std::abs(station), station))) {
      best = value;
      station = here;
    }
  }
  return station;
}

}  // namespace s2s::products
