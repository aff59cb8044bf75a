#include <ceres/autodiff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/product_manifold.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "fixed_random.h"
#include "s2s/core/error.h"
#include "s2s/graph/graph_io.h"
#include "s2s/graph/optimizer.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::FixedRandom;
using graph::test::perturbed;

namespace {

PoseConstraint stepAlongX(std::int64_t from, std::int64_t to, double x, double weight) {
  PoseConstraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.T_from_to.translation().x() = x;
  constraint.information *= weight;
  return constraint;
}

PoseGraph lineGraph(int nodes) {
  PoseGraph graph;
  for (int n = 0; n < nodes; ++n) graph.nodes.push_back({n, core::Isometry::Identity(), n == 0});
  return graph;
}

/// The same residual written anew with Ceres' own rotations and automatic derivatives.
struct AutoDiffBetween {
  core::Isometry measured;
  core::Matrix6 sqrtInformation;
  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    const T qa[4] = {a[6], a[3], a[4], a[5]}, qb[4] = {b[6], b[3], b[4], b[5]};
    const Eigen::Quaterniond m(measured.linear());
    const T qmInverse[4] = {T(m.w()), T(-m.x()), T(-m.y()), T(-m.z())};
    const T qaInverse[4] = {qa[0], -qa[1], -qa[2], -qa[3]};
    T qab[4], D[4], t[3];
    ceres::QuaternionProduct(qaInverse, qb, qab);
    ceres::QuaternionProduct(qmInverse, qab, D);
    const T world[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    ceres::QuaternionRotatePoint(qaInverse, world, t);
    const T offset[3] = {t[0] - measured.translation().x(), t[1] - measured.translation().y(),
                         t[2] - measured.translation().z()};
    Eigen::Matrix<T, 6, 1> e;
    ceres::QuaternionRotatePoint(qmInverse, offset, e.data());
    const T sign = D[0] < T(0) ? T(-2) : T(2);
    for (int i = 0; i < 3; ++i) e[3 + i] = sign * D[1 + i];
    Eigen::Map<Eigen::Matrix<T, 6, 1>>{residual} = sqrtInformation.cast<T>() * e;
    return true;
  }
};

double referenceCost(const PoseGraph& graph) {
  const auto index = nodeIndex(graph, "test");
  std::vector<std::array<double, 7>> blocks(graph.nodes.size());
  ceres::Problem problem;
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    Eigen::Map<Eigen::Vector3d>{blocks[n].data()} = graph.nodes[n].T_map_node.translation();
    Eigen::Map<Eigen::Quaterniond>{blocks[n].data() + 3} = Eigen::Quaterniond(graph.nodes[n].T_map_node.linear());
    problem.AddParameterBlock(
        blocks[n].data(), 7, new ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::EigenQuaternionManifold>());
  }
  for (const auto& c : graph.constraints)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<AutoDiffBetween, 6, 7, 7>(
                                 new AutoDiffBetween{c.T_from_to, core::Matrix6(c.information.llt().matrixU())}),
                             nullptr, blocks[index.at(c.from)].data(), blocks[index.at(c.to)].data());
  problem.SetParameterBlockConstant(blocks[0].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.final_cost;
}

}  // namespace

TEST(Optimizer, TwoWeightedEdges_GiveTheWeightedMean) {
  // x = 1 with weight 100 and x = 2 with weight 1: 102 / 101. MRPT's optimiser stays at a start of 1.6.
  for (const double start : {0.0, 1.4, 1.6, 30.0}) {
    PoseGraph graph = lineGraph(2);
    graph.nodes[1].T_map_node.translation().x() = start;
    graph.constraints = {stepAlongX(0, 1, 1, 100), stepAlongX(0, 1, 2, 1)};
    const SolveSummary summary = optimize(graph);
    EXPECT_EQ(summary.status, SolveStatus::converged);
    EXPECT_NEAR(graph.nodes[1].T_map_node.translation().x(), 102.0 / 101.0, 1e-6);  // the solver's tolerance
    EXPECT_NEAR(summary.finalCost, 0.5 * (100 * std::pow(1 / 101.0, 2) + std::pow(100 / 101.0, 2)), 1e-9);
  }
}

TEST(Optimizer, LoopWithOneMetreOfError_SpreadsItByVariance) {
  // Steps of 1 m with weights 1, 1, 4 and a closure of 2 m back to the start with weight 4: the error of 1 m is shared
  // in proportion to the variances 1, 1, 1/4, 1/4.
  PoseGraph graph = lineGraph(4);
  graph.constraints = {stepAlongX(0, 1, 1, 1), stepAlongX(1, 2, 1, 1), stepAlongX(2, 3, 1, 4), stepAlongX(0, 3, 2, 4)};
  optimize(graph);
  EXPECT_NEAR(graph.nodes[1].T_map_node.translation().x(), 1 - 1 / 2.5, 1e-6);
  EXPECT_NEAR(graph.nodes[2].T_map_node.translation().x(), 2 - 2 / 2.5, 1e-6);
  EXPECT_NEAR(graph.nodes[3].T_map_node.translation().x(), 3 - 2.25 / 2.5, 1e-6);
}

TEST(Optimizer, ConsistentGraphFromADisturbedStart_FindsTheTruth) {
  FixedRandom random(11);
  PoseGraph graph;
  std::vector<core::Isometry> truth;
  for (int n = 0; n < 30; ++n) {
    truth.push_back(core::isometryFromXyzYpr(10 * std::cos(0.2 * n), 10 * std::sin(0.2 * n), 0.1 * n, 0.2 * n, 0.1, 0));
    graph.nodes.push_back({n, n == 0 ? truth[0] : perturbed(truth.back(), random.normal6(0.5, 0.2)), n == 0});
  }
  for (int n = 0; n < 30; ++n)
    for (const int step : {1, 7})
      if (n + step < 30) graph.constraints.push_back({n, n + step, truth[n].inverse() * truth[n + step]});
  optimize(graph);
  for (int n = 0; n < 30; ++n) EXPECT_TRUE(graph.nodes[n].T_map_node.isApprox(truth[n], 1e-6)) << n;
}

TEST(Optimizer, FixedNode_StaysWhereItIs) {
  PoseGraph graph = lineGraph(3);
  graph.nodes[0].fixed = false;
  graph.nodes[2].fixed = true;
  graph.nodes[2].T_map_node.translation() << 5, 6, 7;
  graph.constraints = {stepAlongX(0, 1, 1, 1), stepAlongX(1, 2, 1, 1)};
  optimize(graph);
  EXPECT_EQ(graph.nodes[2].T_map_node.translation(), Eigen::Vector3d(5, 6, 7));
  EXPECT_NEAR(graph.nodes[0].T_map_node.translation().x(), 3, 1e-6);  // the solver's tolerance
}

TEST(Optimizer, NoNodeOrUnknownNode_IsRefused) {
  PoseGraph empty;
  EXPECT_THROW(optimize(empty), core::InputError);
  PoseGraph graph = lineGraph(2);
  graph.constraints = {stepAlongX(0, 5, 1, 1)};
  EXPECT_THROW(optimize(graph), core::InputError);
}

TEST(Optimizer, ParkingGarage_ReachesTheCostOfAutomaticDerivatives) {
  const std::string path = std::string(S2S_DATA_DIR) + "/posegraph/parking-garage.g2o";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no data at " << path;
  PoseGraph graph = readGraph(path).graph;
  const double reference = referenceCost(graph);
  const SolveSummary summary = optimize(graph);
  EXPECT_LE(summary.finalCost, reference * (1 + 1e-6));  // "to 6 digits"
  EXPECT_NEAR(cost(graph), summary.finalCost, 1e-9 * summary.finalCost);
}

TEST(CountConnectedParts, TwoIslands_AreTwo) {
  PoseGraph graph = lineGraph(4);
  graph.constraints = {stepAlongX(0, 1, 1, 1), stepAlongX(2, 3, 1, 1)};
  EXPECT_EQ(countConnectedParts(graph), 2U);
  graph.constraints.push_back(stepAlongX(3, 0, 1, 1));
  EXPECT_EQ(countConnectedParts(graph), 1U);
}
