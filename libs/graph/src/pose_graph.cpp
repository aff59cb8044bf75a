#include "s2s/graph/pose_graph.h"

#include <numeric>

#include "s2s/core/error.h"

namespace s2s::graph {

namespace {

std::size_t rootOf(std::vector<std::size_t>& parents, std::size_t node) {
  while (parents[node] != node) node = parents[node] = parents[parents[node]];
  return node;
}

std::size_t positionOf(const std::map<std::int64_t, std::size_t>& index, std::int64_t id) {
  const auto found = index.find(id);
  if (found == index.end())
    throw core::InputError("a constraint names node " + std::to_string(id) + ", which does not exist", "pose graph",
                           "give every node a pose");
  return found->second;
}

}  // namespace

std::map<std::int64_t, std::size_t> nodeIndex(const PoseGraph& graph, const std::string& where) {
  std::map<std::int64_t, std::size_t> index;
  for (std::size_t n = 0; n < graph.nodes.size(); ++n)
    if (!index.emplace(graph.nodes[n].id, n).second)
      throw core::InputError("node " + std::to_string(graph.nodes[n].id) + " stands twice", where,
                             "give every node an id of its own");
  return index;
}

std::size_t countConnectedParts(const PoseGraph& graph) {
  const auto index = nodeIndex(graph, "pose graph");
  std::vector<std::size_t> parents(graph.nodes.size());
  std::iota(parents.begin(), parents.end(), 0);
  std::size_t parts = parents.size();
  for (const auto& constraint : graph.constraints) {
    const std::size_t a = rootOf(parents, positionOf(index, constraint.from));
    const std::size_t b = rootOf(parents, positionOf(index, constraint.to));
    if (a == b) continue;
    parents[a] = b;
    --parts;
  }
  return parts;
}

}  // namespace s2s::graph
