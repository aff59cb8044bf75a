#include <algorithm>
#include <cstdio>
#include <memory>

#include "command_line.h"
#include "commands.h"
#include "rotation_option.h"
#include "s2s/graph/graph_io.h"
#include "s2s/graph/optimizer.h"

namespace s2s::apps {

namespace {

struct InfoArguments {
  std::string input;
  graph::G2oRotation rotation = graph::G2oRotation::quaternion;
};

void printExtent(const graph::PoseGraph& graph) {
  Eigen::Vector3d low = graph.nodes.front().T_map_node.translation(), high = low;
  for (const auto& node : graph.nodes) {
    low = low.cwiseMin(node.T_map_node.translation());
    high = high.cwiseMax(node.T_map_node.translation());
  }
  std::printf("extent       x %.3f to %.3f, y %.3f to %.3f, z %.3f to %.3f m\n", low.x(), high.x(), low.y(), high.y(),
              low.z(), high.z());
}

int printInfo(const InfoArguments& arguments) {
  const graph::GraphFile file = graph::readGraph(arguments.input, arguments.rotation);
  const graph::PoseGraph& graph = file.graph;
  const auto steps = std::count_if(graph.constraints.begin(), graph.constraints.end(),
                                   [](const auto& constraint) { return constraint.to == constraint.from + 1; });
  const auto fixed = std::count_if(graph.nodes.begin(), graph.nodes.end(), [](const auto& node) { return node.fixed; });
  std::printf("poses        %zu, %ld fixed\n", graph.nodes.size(), static_cast<long>(fixed));
  std::printf("constraints  %zu: %ld between successive poses, %ld others\n", graph.constraints.size(),
              static_cast<long>(steps), static_cast<long>(graph.constraints.size()) - static_cast<long>(steps));
  std::printf("parts        %zu%s\n", graph::countConnectedParts(graph),
              graph::countConnectedParts(graph) == 1 ? "" : " (not connected: their relative poses are unknown)");
  std::printf("cost         %.9g\n", graph::cost(graph));
  printExtent(graph);
  for (const auto& [tag, count] : file.ignoredLines) std::printf("ignored      %d lines '%s'\n", count, tag.c_str());
  return kSuccess;
}

}  // namespace

void addInfoCommand(CLI::App& app, std::function<int()>& body) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand("info", "Prints size, connectivity, cost and extent of a pose graph.");
  command->add_option("input", arguments->input, "Pose graph, .g2o or .graph")->required()->option_text("FILE");
  addRotationOption(*command, arguments->rotation);
  command->callback([&body, arguments] { body = [arguments] { return printInfo(*arguments); }; });
}

}  // namespace s2s::apps
