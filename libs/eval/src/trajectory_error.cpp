#include "s2s/eval/trajectory_error.h"

#include <mrpt/core/exceptions.h>

#include <algorithm>

#include "s2s/eval/alignment.h"

namespace s2s::eval {

namespace {

using core::Isometry;
using IndexPair = std::pair<std::size_t, std::size_t>;

/// (Q_i^-1 Q_j)^-1 (P_i^-1 P_j).
Isometry relativeMotionError(const PosePair& i, const PosePair& j) {
  const Isometry Q = i.T_ref_body.inverse() * j.T_ref_body;
  const Isometry P = i.T_est_body.inverse() * j.T_est_body;
  return Q.inverse() * P;
}

double angleOf(const Isometry& T) { return core::angleBetween(Eigen::Matrix3d::Identity(), T.linear()); }

RelativeError relativeError(const std::vector<PosePair>& pairs, const std::vector<IndexPair>& indices) {
  std::vector<double> translation_m, rotation_rad;
  for (const auto& [i, j] : indices) {
    const Isometry E = relativeMotionError(pairs[i], pairs[j]);
    translation_m.push_back(E.translation().norm());
    rotation_rad.push_back(angleOf(E));
  }
  return {summarise(std::move(translation_m)), summarise(std::move(rotation_rad))};
}

Isometry align(const std::vector<PosePair>& pairs, TrajectoryAlignment alignment) {
  if (alignment == TrajectoryAlignment::Poses) {
    std::vector<Isometry> est, ref;
    for (const auto& pair : pairs) {
      est.push_back(pair.T_est_body);
      ref.push_back(pair.T_ref_body);
    }
    return alignPoses(est, ref, kPoseAlignmentLever_m);
  }
  std::vector<Eigen::Vector3d> est, ref;
  for (const auto& pair : pairs) {
    est.emplace_back(pair.T_est_body.translation());
    ref.emplace_back(pair.T_ref_body.translation());
  }
  return alignPoints(est, ref).T_target_source;
}

/// Distance travelled along the reference up to each pair.
std::vector<double> referencePath(const std::vector<PosePair>& pairs) {
  std::vector<double> path_m(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i)
    path_m[i] = path_m[i - 1] + (pairs[i].T_ref_body.translation() - pairs[i - 1].T_ref_body.translation()).norm();
  return path_m;
}

}  // namespace

std::vector<PosePair> pairByTime(const core::Trajectory& reference, const core::Trajectory& estimate, double maxGap_s) {
  std::vector<PosePair> pairs;
  pairs.reserve(estimate.size());
  for (const auto& pose : estimate.poses())
    if (const auto T_ref = reference.at(pose.time, maxGap_s)) pairs.push_back({pose.time, *T_ref, pose.T});
  return pairs;
}

AbsoluteError absoluteError(const std::vector<PosePair>& pairs, TrajectoryAlignment alignment) {
  ASSERT_(!pairs.empty());
  AbsoluteError result;
  result.T_ref_est = align(pairs, alignment);
  std::vector<double> translation_m, rotation_rad;
  for (const auto& pair : pairs) {
    const Isometry T_ref_body = result.T_ref_est * pair.T_est_body;
    translation_m.push_back((pair.T_ref_body.translation() - T_ref_body.translation()).norm());
    rotation_rad.push_back(core::angleBetween(pair.T_ref_body.linear(), T_ref_body.linear()));
  }
  result.translation_m = summarise(std::move(translation_m));
  result.rotation_rad = summarise(std::move(rotation_rad));
  return result;
}

RelativeError relativeErrorOverFrames(const std::vector<PosePair>& pairs, std::size_t frames) {
  ASSERT_(frames >= 1);
  std::vector<IndexPair> indices;
  for (std::size_t i = 0; i + frames < pairs.size(); i += frames) indices.emplace_back(i, i + frames);
  return relativeError(pairs, indices);
}

RelativeError relativeErrorOverDistance(const std::vector<PosePair>& pairs, double distance_m) {
  ASSERT_(distance_m > 0);
  std::vector<std::size_t> marks;
  double travelled_m = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    travelled_m += (pairs[i].T_est_body.translation() - pairs[i - 1].T_est_body.translation()).norm();
    if (travelled_m < distance_m) continue;
    marks.push_back(i);
    travelled_m = 0;
  }
  std::vector<IndexPair> indices;
  for (std::size_t k = 1; k < marks.size(); ++k) indices.emplace_back(marks[k - 1], marks[k]);
  return relativeError(pairs, indices);
}

SegmentError segmentError(const std::vector<PosePair>& pairs, double length_m, double step_m) {
  ASSERT_(length_m > 0 && step_m > 0);
  SegmentError result;
  result.length_m = length_m;
  const std::vector<double> path_m = referencePath(pairs);
  double nextStart_m = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (path_m[i] < nextStart_m) continue;
    const auto end = std::lower_bound(path_m.begin(), path_m.end(), path_m[i] + length_m);
    if (end == path_m.end()) break;
    const Isometry E = relativeMotionError(pairs[i], pairs[static_cast<std::size_t>(end - path_m.begin())]);
    result.translation_share += E.translation().norm() / length_m;
    result.rotation_radpm += angleOf(E) / length_m;
    ++result.count;
    nextStart_m = path_m[i] + step_m;
  }
  if (result.count > 0) {
    result.translation_share /= static_cast<double>(result.count);
    result.rotation_radpm /= static_cast<double>(result.count);
  }
  return result;
}

}  // namespace s2s::eval
