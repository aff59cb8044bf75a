#pragma once

#include <mrpt/graphs/CNetworkOfPoses.h>

#include "s2s/graph/pose_graph.h"

namespace s2s::graph {

/// Information of a relative pose in MRPT's parameters (x, y, z, yaw, pitch, roll), which
/// `mrpt::poses::CPose3DPDFGaussianInf::cov_inv` holds, and back to that of a body perturbation. Undefined at a pitch
/// of exactly 90 degrees, where MRPT's angles are.
core::Matrix6 informationToMrpt(const core::Isometry& T, const core::Matrix6& information_body);
core::Matrix6 informationFromMrpt(const core::Isometry& T, const core::Matrix6& information_xyzypr);

/// The graph as MRPT's own type: nodes, constraints with information, and as root the first fixed node (else the
/// first).
mrpt::graphs::CNetworkOfPoses3DInf toMrptNetwork(const PoseGraph& graph);
PoseGraph fromMrptNetwork(const mrpt::graphs::CNetworkOfPoses3DInf& network);

}  // namespace s2s::graph
