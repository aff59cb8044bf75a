#include <cstdio>
#include <memory>

#include "command_line.h"
#include "commands.h"
#include "rotation_option.h"
#include "s2s/graph/graph_io.h"
#include "s2s/graph/optimizer.h"

namespace s2s::apps {

namespace {

struct OptimizeArguments {
  std::string input, output;
  graph::G2oRotation rotation = graph::G2oRotation::quaternion;
  graph::OptimizerOptions options;
};

int optimizeFile(const OptimizeArguments& arguments) {
  graph::PoseGraph graph = graph::readGraph(arguments.input, arguments.rotation).graph;
  const graph::SolveSummary summary = graph::optimize(graph, arguments.options);
  std::printf("poses        %zu\n", graph.nodes.size());
  std::printf("constraints  %zu\n", graph.constraints.size());
  std::printf("initial cost %.9g\n", summary.initialCost);
  std::printf("final cost   %.9g   (half the weighted sum of squares; g2o's chi2 is twice that)\n", summary.finalCost);
  std::printf("iterations   %d, %s\n", summary.iterations, graph::solveStatusName(summary.status));
  std::printf("time         %.3f s\n", summary.time_s);
  if (summary.status == graph::SolveStatus::failed) {
    std::fprintf(stderr, "seabed-sky-graph: the optimiser failed: %s\n", summary.message.c_str());
    return kUnusableInput;
  }
  if (!arguments.output.empty()) graph::writeGraph(arguments.output, graph, arguments.rotation);
  return kSuccess;
}

}  // namespace

void addOptimizeCommand(CLI::App& app, std::function<int()>& body) {
  auto arguments = std::make_shared<OptimizeArguments>();
  CLI::App* command = app.add_subcommand(
      "optimize",
      "Moves the poses to the least-squares optimum of all constraints, from the poses in the file. Fixed poses (FIX) "
      "are held; without any, the first is.");
  command->add_option("input", arguments->input, "Pose graph, .g2o or .graph")->required()->option_text("FILE");
  command->add_option("-o,--output", arguments->output, "Where to write the result; .g2o or .graph by extension")
      ->option_text("FILE");
  command->add_option("--max-iterations", arguments->options.maxIterations, "Iterations at most (default 100)")
      ->check(CLI::PositiveNumber)
      ->option_text("N");
  command->add_option("--threads", arguments->options.threads, "Threads (default 1)")
      ->check(CLI::PositiveNumber)
      ->option_text("N");
  addRotationOption(*command, arguments->rotation);
  command->callback([&body, arguments] { body = [arguments] { return optimizeFile(*arguments); }; });
}

}  // namespace s2s::apps
