#pragma once

#include <map>
#include <string>

#include "s2s/graph/pose_graph.h"

namespace s2s::graph {

/// What the information matrix of an `EDGE_SE3:QUAT` refers to.
enum class G2oRotation {
  quaternion,  ///< vector part of the error quaternion, half the angle: what g2o itself does
  angle        ///< rotation vector: how GTSAM, SE-Sync and Ceres' example read the same files
};

struct GraphFile {
  PoseGraph graph;
  std::map<std::string, int> ignoredLines;  ///< tags that are no pose and no relative pose, and how often they stand
};

/// Reads a text pose graph, g2o's or MRPT's: `VERTEX_SE3:QUAT`, `EDGE_SE3:QUAT`, `VERTEX3`, `EDGE3` and `FIX` lines, in
/// any order and mixture. Lines starting with '#' and empty lines are skipped.
/// @throws core::InputError with file and line if it is missing, a line does not parse, a number is not finite, an
///         information matrix is not symmetric positive semi-definite, an id stands twice, a constraint or FIX names
///         a node that does not exist, or there is no node at all
GraphFile readGraph(const std::string& path, G2oRotation rotation = G2oRotation::quaternion);

/// Writes g2o's text: 17 significant digits, so that it reads back to the same numbers.
/// @throws core::OutputError
void writeG2o(const std::string& path, const PoseGraph& graph, G2oRotation rotation = G2oRotation::quaternion);

/// Writes MRPT's text (`VERTEX3`, `EDGE3`), which `mrpt::graphs::CNetworkOfPoses3DInf` and the `graph-slam` app read:
/// 17 significant digits, angles and information in the order x y z roll pitch yaw.
/// @throws core::OutputError
void writeMrptGraph(const std::string& path, const PoseGraph& graph);

/// Writes by the name's extension: `.g2o` or `.graph`.
/// @throws core::ConfigError for another extension, core::OutputError
void writeGraph(const std::string& path, const PoseGraph& graph, G2oRotation rotation = G2oRotation::quaternion);

}  // namespace s2s::graph
