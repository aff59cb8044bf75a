#include <gtest/gtest.h>

#include "fixed_random.h"
#include "s2s/graph/graph_io.h"
#include "s2s/graph/mrpt_network.h"
#include "temp_folder.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::FixedRandom;
using graph::test::perturbed;

namespace {

core::Vector6 mrptParameters(const core::Isometry& T) {
  const auto pose = core::toPose(T);
  core::Vector6 v;
  v << pose.x(), pose.y(), pose.z(), pose.yaw(), pose.pitch(), pose.roll();
  return v;
}

core::Matrix6 randomInformation(FixedRandom& random) {
  core::Matrix6 A;
  for (double& value : A.reshaped()) value = random.normal();
  return A * A.transpose();
}

}  // namespace

TEST(InformationToMrpt, QuadraticForm_IsThatOfMrptsParameters) {
  FixedRandom random(31);
  for (int trial = 0; trial < 20; ++trial) {
    const core::Isometry T = random.pose(10, 0.6);
    const core::Matrix6 body = randomInformation(random);
    const core::Matrix6 mrpt = informationToMrpt(T, body);
    const core::Vector6 d = random.normal6(1e-5, 1e-5);
    const core::Vector6 p = mrptParameters(perturbed(T, d)) - mrptParameters(T);
    // First-order equality: steps of 1e-5 leave 1e-5 relative, times the curvature near steep pitch.
    EXPECT_NEAR(p.dot(mrpt * p) / d.dot(body * d), 1, 2e-3);
    EXPECT_TRUE(informationFromMrpt(T, mrpt).isApprox(body, 1e-9));
  }
}

TEST(InformationToMrpt, YawInformation_StandsInRowThree) {
  core::Matrix6 body = core::Matrix6::Zero();
  body(5, 5) = 7;  // rotation about z
  EXPECT_NEAR(informationToMrpt(core::Isometry::Identity(), body)(3, 3), 7, 1e-12);
}

TEST(ToMrptNetwork, ThereAndBack_IsTheSame) {
  FixedRandom random(32);
  PoseGraph graph;
  for (int n = 0; n < 4; ++n) graph.nodes.push_back({n, random.pose(10, 0.5), n == 1});
  for (int n = 0; n < 3; ++n) graph.constraints.push_back({n, n + 1, random.pose(2, 0.5), randomInformation(random)});
  const auto network = toMrptNetwork(graph);
  EXPECT_EQ(network.root, 1U);
  const PoseGraph back = fromMrptNetwork(network);
  ASSERT_EQ(back.nodes.size(), 4U);
  ASSERT_EQ(back.constraints.size(), 3U);
  for (int n = 0; n < 4; ++n) EXPECT_TRUE(back.nodes[n].T_map_node.isApprox(graph.nodes[n].T_map_node, 1e-12));
  for (int c = 0; c < 3; ++c)
    EXPECT_TRUE(back.constraints[c].information.isApprox(graph.constraints[c].information, 1e-9));
}

TEST(ToMrptNetwork, OurGraphFile_IsReadByMrptToTheSame) {
  FixedRandom random(33);
  PoseGraph graph;
  for (int n = 0; n < 3; ++n) graph.nodes.push_back({n, random.pose(10, 0.5), n == 0});
  for (int n = 0; n < 2; ++n) graph.constraints.push_back({n, n + 1, random.pose(2, 0.5), randomInformation(random)});
  const s2s::test::TempFolder folder;
  const auto path = folder.file("three.graph");
  writeMrptGraph(path, graph);
  mrpt::graphs::CNetworkOfPoses3DInf read;
  read.loadFromTextFile(path);

  const auto expected = toMrptNetwork(graph);
  ASSERT_EQ(read.nodes.size(), expected.nodes.size());
  ASSERT_EQ(read.edges.size(), expected.edges.size());
  auto edge = expected.edges.begin();
  for (const auto& [ids, pdf] : read.edges) {
    EXPECT_EQ(ids, edge->first);
    // MRPT 2.5.8 reads the three products of different angles into one triangle and then copies the other, empty one
    // over it; all else arrives, by 17 digits in the file.
    const core::Matrix6 got = pdf.cov_inv.asEigen(), sent = edge->second.cov_inv.asEigen();
    EXPECT_TRUE(got.topRows<3>().isApprox(sent.topRows<3>(), 1e-12));
    EXPECT_TRUE(got.diagonal().isApprox(sent.diagonal(), 1e-12));
    EXPECT_NEAR(mrpt::poses::CPose3D(pdf.mean - edge->second.mean).norm(), 0, 1e-12);
    ++edge;
  }
  for (const auto& [id, pose] : read.nodes)
    EXPECT_TRUE(core::toIsometry(pose).isApprox(core::toIsometry(expected.nodes.at(id)), 1e-12));
}
