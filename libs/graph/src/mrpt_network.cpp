#include "s2s/graph/mrpt_network.h"

namespace s2s::graph {

namespace {

/// d(x, y, z, yaw, pitch, roll) / d(body perturbation) at T. With R = Rz(yaw) Ry(pitch) Rx(roll) the body's angular
/// rates are E (yaw', pitch', roll'); the lower block is the inverse of E.
core::Matrix6 mrptByBody(const core::Isometry& T) {
  const Eigen::Matrix3d R = T.linear();
  const double cosPitch = std::hypot(R(0, 0), R(1, 0));
  const double sinPitch = -R(2, 0);
  const double sinRoll = R(2, 1) / cosPitch, cosRoll = R(2, 2) / cosPitch;
  core::Matrix6 J = core::Matrix6::Zero();
  J.topLeftCorner<3, 3>() = R;
  J.bottomRightCorner<3, 3>() << 0, sinRoll / cosPitch, cosRoll / cosPitch,  //
      0, cosRoll, -sinRoll,                                                  //
      1, sinRoll * sinPitch / cosPitch, cosRoll * sinPitch / cosPitch;
  return J;
}

core::Matrix6 symmetric(const core::Matrix6& M) { return 0.5 * (M + M.transpose()); }

}  // namespace

core::Matrix6 informationToMrpt(const core::Isometry& T, const core::Matrix6& information_body) {
  const core::Matrix6 bodyByMrpt = mrptByBody(T).inverse();
  return symmetric(bodyByMrpt.transpose() * information_body * bodyByMrpt);
}

core::Matrix6 informationFromMrpt(const core::Isometry& T, const core::Matrix6& information_xyzypr) {
  const core::Matrix6 J = mrptByBody(T);
  return symmetric(J.transpose() * information_xyzypr * J);
}

mrpt::graphs::CNetworkOfPoses3DInf toMrptNetwork(const PoseGraph& graph) {
  mrpt::graphs::CNetworkOfPoses3DInf network;
  bool hasRoot = false;
  for (const auto& node : graph.nodes) {
    const auto id = static_cast<mrpt::graphs::TNodeID>(node.id);
    network.nodes[id] = core::toPose(node.T_map_node);
    if (hasRoot || !node.fixed) continue;
    network.root = id;
    hasRoot = true;
  }
  if (!hasRoot && !graph.nodes.empty()) network.root = static_cast<mrpt::graphs::TNodeID>(graph.nodes.front().id);
  for (const auto& constraint : graph.constraints) {
    mrpt::poses::CPose3DPDFGaussianInf edge(core::toPose(constraint.T_from_to));
    edge.cov_inv = mrpt::math::CMatrixDouble66(informationToMrpt(constraint.T_from_to, constraint.information));
    network.insertEdgeAtEnd(static_cast<mrpt::graphs::TNodeID>(constraint.from),
                            static_cast<mrpt::graphs::TNodeID>(constraint.to), edge);
  }
  return network;
}

PoseGraph fromMrptNetwork(const mrpt::graphs::CNetworkOfPoses3DInf& network) {
  PoseGraph graph;
  for (const auto& [id, pose] : network.nodes)
    graph.nodes.push_back({static_cast<std::int64_t>(id), core::toIsometry(pose), id == network.root});
  for (const auto& [ids, edge] : network.edges) {
    PoseConstraint constraint;
    constraint.from = static_cast<std::int64_t>(ids.first);
    constraint.to = static_cast<std::int64_t>(ids.second);
    constraint.T_from_to = core::toIsometry(edge.mean);
    constraint.information = informationFromMrpt(constraint.T_from_to, edge.cov_inv.asEigen());
    graph.constraints.push_back(constraint);
  }
  return graph;
}

}  // namespace s2s::graph
