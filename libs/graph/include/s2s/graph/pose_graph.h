#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "s2s/core/transform.h"

namespace s2s::graph {

/// A pose to be estimated.
struct PoseNode {
  std::int64_t id = 0;
  core::Isometry T_map_node = core::Isometry::Identity();
  bool fixed = false;  ///< held at its value by the optimiser
};

/// A measured relative pose between two nodes.
///
/// `information` is the inverse of the covariance of a right (body) perturbation of T_from_to, translation [m] before
/// rotation vector [rad]. It may be singular: a direction without information is not constrained.
struct PoseConstraint {
  std::int64_t from = 0, to = 0;
  core::Isometry T_from_to = core::Isometry::Identity();
  core::Matrix6 information = core::Matrix6::Identity();
};

/// A pose-graph problem as files hold it: nodes in the file's order, constraints by node id.
struct PoseGraph {
  std::vector<PoseNode> nodes;
  std::vector<PoseConstraint> constraints;
};

/// Position of every node id in `graph.nodes`.
/// @throws core::InputError if an id stands twice; `where` names the graph in the message
std::map<std::int64_t, std::size_t> nodeIndex(const PoseGraph& graph, const std::string& where);

/// Number of groups of nodes that constraints connect; 1 for a usable graph.
/// @throws core::InputError if a constraint names a node that does not exist
std::size_t countConnectedParts(const PoseGraph& graph);

}  // namespace s2s::graph
