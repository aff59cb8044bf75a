#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fixed_random.h"
#include "s2s/core/error.h"
#include "s2s/graph/graph_io.h"
#include "s2s/graph/optimizer.h"
#include "temp_folder.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::FixedRandom;
using testing::HasSubstr;

namespace {

class GraphIo : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.file(name); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  void expectRefused(const std::string& text, const std::string& where, const std::string& fault) const {
    const std::string file = write("bad.g2o", text);
    try {
      readGraph(file);
      FAIL() << "accepted: " << text;
    } catch (const core::InputError& e) {
      EXPECT_EQ(e.where(), file + where) << e.what();
      EXPECT_THAT(e.fault(), HasSubstr(fault));
      EXPECT_FALSE(e.remedy().empty());
    }
  }

 private:
  s2s::test::TempFolder folder_;
};

PoseGraph randomGraph() {
  FixedRandom random(21);
  PoseGraph graph;
  // Coordinates of a national grid: six digits would lose half a metre.
  for (int n = 0; n < 5; ++n) {
    core::Isometry T = random.pose(100, 0.7);
    T.translation() += Eigen::Vector3d(512345.678912, 6172345.67, 3);
    graph.nodes.push_back({3 * n, T, n == 2});
  }
  for (int n = 0; n < 4; ++n) {
    core::Matrix6 A;
    for (double& value : A.reshaped()) value = random.normal();
    graph.constraints.push_back({3 * n, 3 * n + 3, random.pose(5, 0.7), A * A.transpose()});
  }
  return graph;
}

void expectSame(const PoseGraph& a, const PoseGraph& b, double metres, double relative) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  ASSERT_EQ(a.constraints.size(), b.constraints.size());
  for (std::size_t n = 0; n < a.nodes.size(); ++n) {
    EXPECT_EQ(a.nodes[n].id, b.nodes[n].id);
    EXPECT_EQ(a.nodes[n].fixed, b.nodes[n].fixed);
    EXPECT_LE((a.nodes[n].T_map_node.translation() - b.nodes[n].T_map_node.translation()).norm(), metres);
    EXPECT_LE((a.nodes[n].T_map_node.linear() - b.nodes[n].T_map_node.linear()).norm(), 1e-14);
  }
  for (std::size_t c = 0; c < a.constraints.size(); ++c) {
    EXPECT_EQ(a.constraints[c].from, b.constraints[c].from);
    EXPECT_EQ(a.constraints[c].to, b.constraints[c].to);
    EXPECT_TRUE(a.constraints[c].T_from_to.isApprox(b.constraints[c].T_from_to, 1e-14));
    EXPECT_TRUE(a.constraints[c].information.isApprox(b.constraints[c].information, relative));
  }
}

const std::string kInformation = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";
const std::string kVertices = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\n";

}  // namespace

TEST_F(GraphIo, G2oWrittenAndRead_IsTheSame) {
  const PoseGraph graph = randomGraph();
  writeG2o(path("a.g2o"), graph);
  // Translations bit for bit; rotations through a quaternion to rounding; information by powers of two, bit for bit.
  expectSame(graph, readGraph(path("a.g2o")).graph, 0, 1e-15);
}

TEST_F(GraphIo, MrptGraphWrittenAndRead_IsTheSame) {
  const PoseGraph graph = randomGraph();
  writeMrptGraph(path("a.graph"), graph);
  // The information goes through the Jacobian of the angles and back: some rounding.
  expectSame(graph, readGraph(path("a.graph")).graph, 0, 1e-12);
}

TEST_F(GraphIo, G2oInformation_WeighsHalfTheAngle) {
  // g2o's chi2 of an error of w rad about z with rotational information 4 is 4 (w/2)^2 = w^2 for small w.
  std::string information = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4";
  const double w = 1e-3;
  std::ostringstream vertex;
  vertex.precision(17);
  vertex << "VERTEX_SE3:QUAT 1 0 0 0 0 0 " << std::sin(w / 2) << ' ' << std::cos(w / 2) << '\n';
  const std::string file = write(
      "a.g2o", "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n" + vertex.str() + "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1" + information);
  EXPECT_NEAR(cost(readGraph(file).graph), 0.5 * w * w, 1e-12);
  EXPECT_NEAR(cost(readGraph(file, G2oRotation::angle).graph), 0.5 * 4 * w * w, 1e-12);
}

TEST_F(GraphIo, Extension_ChoosesTheFormat) {
  const PoseGraph graph = randomGraph();
  writeGraph(path("a.g2o"), graph);
  writeGraph(path("a.graph"), graph);
  EXPECT_EQ(readGraph(path("a.g2o")).graph.nodes.size(), 5U);
  EXPECT_EQ(readGraph(path("a.graph")).graph.nodes.size(), 5U);
  EXPECT_THROW(writeGraph(path("a.txt"), graph), core::ConfigError);
  EXPECT_FALSE(std::filesystem::exists(path("a.txt")));
}

TEST_F(GraphIo, OtherLines_AreCounted) {
  const std::string file = write("a.g2o", "# comment\n\n" + kVertices + "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\nFIX 0\n");
  const GraphFile read = readGraph(file);
  EXPECT_EQ(read.ignoredLines.at("PARAMS_SE3OFFSET"), 1);
  EXPECT_TRUE(read.graph.nodes[0].fixed);
}

TEST_F(GraphIo, KeysOf64Bits_AreKept) {
  const std::string file = write("a.g2o", "VERTEX_SE3:QUAT 6989586621679009792 0 0 0 0 0 0 1\n");
  EXPECT_EQ(readGraph(file).graph.nodes[0].id, 6989586621679009792);
}

TEST_F(GraphIo, MalformedFiles_AreRefusedWithFileAndLine) {
  expectRefused("", ":0", "no pose");
  expectRefused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0\n", ":1", "ends before qx qy qz qw");
  expectRefused("VERTEX_SE3:QUAT x 0 0 0 0 0 0 1\n", ":1", "'x' is no node id");
  expectRefused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1 2\n", ":1", "'2' stands behind");
  expectRefused("VERTEX_SE3:QUAT 0 0 0 nan 0 0 0 1\n", ":1", "'nan'");
  expectRefused("VERTEX_SE3:QUAT 0 0 0 3.5abc 0 0 0 1\n", ":1", "'3.5abc'");
  expectRefused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 2\n", ":1", "quaternion's length");
  expectRefused("VERTEX_SE2 0 0 0 0\n", ":1", "2D");
  expectRefused(kVertices + "VERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\n", ":3", "stands twice");
  expectRefused(kVertices + "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 1 0 0\n", ":3", "information matrix");
  expectRefused(kVertices + "EDGE_SE3:QUAT 0 7 1 0 0 0 0 0 1" + kInformation + "\n", ":3", "node 7");
  expectRefused(kVertices + "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 -1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n", ":3",
                "negative eigenvalue");
  expectRefused(kVertices + "\nFIX 9\n", ":4", "FIX names node 9");
}

TEST_F(GraphIo, MissingFile_IsRefused) { EXPECT_THROW(readGraph(path("none.g2o")), core::InputError); }

TEST_F(GraphIo, UnwritableFolder_IsAnOutputError) {
  write("file", "x");
  EXPECT_THROW(writeG2o(path("file/a.g2o"), randomGraph()), core::OutputError);
}
