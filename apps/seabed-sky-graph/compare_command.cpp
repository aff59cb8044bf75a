#include <mrpt/graphslam/levmarq.h>

#include <chrono>
#include <cstdio>
#include <memory>

#include "command_line.h"
#include "commands.h"
#include "rotation_option.h"
#include "s2s/graph/graph_io.h"
#include "s2s/graph/mrpt_network.h"
#include "s2s/graph/optimizer.h"

namespace s2s::apps {

namespace {

struct CompareArguments {
  std::string input;
  graph::G2oRotation rotation = graph::G2oRotation::quaternion;
  int maxIterations = 100;
};

void printRow(const char* name, double cost, int iterations, double time_s) {
  std::printf("%-36s %16.9g %11d %9.3f s\n", name, cost, iterations, time_s);
}

/// The same graph through MRPT's Levenberg-Marquardt, measured by our cost.
void runMrpt(graph::PoseGraph graph, int maxIterations) {
  auto network = graph::toMrptNetwork(graph);
  mrpt::containers::yaml parameters;
  parameters["max_iterations"] = static_cast<std::size_t>(maxIterations);
  mrpt::graphslam::TResultInfoSpaLevMarq info;
  const auto start = std::chrono::steady_clock::now();
  mrpt::graphslam::optimize_graph_spa_levmarq(network, info, nullptr, parameters);
  const double time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (auto& node : graph.nodes)
    node.T_map_node = core::toIsometry(network.nodes.at(static_cast<mrpt::graphs::TNodeID>(node.id)));
  printRow("MRPT Levenberg-Marquardt", graph::cost(graph), static_cast<int>(info.num_iters), time_s);
}

int compare(const CompareArguments& arguments) {
  const graph::PoseGraph graph = graph::readGraph(arguments.input, arguments.rotation).graph;
  std::printf("%zu poses, %zu constraints\n", graph.nodes.size(), graph.constraints.size());
  std::printf("%-36s %16s %11s %11s\n", "", "cost", "iterations", "time");
  printRow("given start", graph::cost(graph), 0, 0);
  graph::PoseGraph ours = graph;
  graph::OptimizerOptions options;
  options.maxIterations = arguments.maxIterations;
  const graph::SolveSummary summary = graph::optimize(ours, options);
  printRow("this program (Ceres, analytic)", summary.finalCost, summary.iterations, summary.time_s);
  runMrpt(graph, arguments.maxIterations);
  return kSuccess;
}

}  // namespace

void addCompareCommand(CLI::App& app, std::function<int()>& body) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand(
      "compare", "Optimises a pose graph with this program and with MRPT's own Levenberg-Marquardt, side by side.");
  command->add_option("input", arguments->input, "Pose graph, .g2o or .graph")->required()->option_text("FILE");
  command->add_option("--max-iterations", arguments->maxIterations, "Iterations at most (default 100)")
      ->check(CLI::PositiveNumber)
      ->option_text("N");
  addRotationOption(*command, arguments->rotation);
  command->callback([&body, arguments] { body = [arguments] { return compare(*arguments); }; });
}

}  // namespace s2s::apps
