#include "s2s/eval/control_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "s2s/core/error.h"
#include "scratch_folder.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

const core::Isometry kMapFromWorld = core::isometryFromXyzYpr(-40, 12, 0.3, 1.2, 0, 0);

/// A square of 20 m, and a fifth point in its middle.
std::vector<NamedPoint> square() {
  return {{"a", {10, 10, 2}, 0.011},
          {"b", {-10, 10, 2}, 0.011},
          {"c", {-10, -10, 2}, 0.011},
          {"d", {10, -10, 2}, 0.011},
          {"e", {0, 0, 2}, 0.011}};
}

std::vector<NamedPoint> picked(std::vector<NamedPoint> points) {
  for (auto& point : points) point.position = kMapFromWorld * point.position;
  return points;
}

}  // namespace

TEST(ControlPoints, ExactPicks_HaveNoError) {
  const ControlReport report = evaluateControlPoints(square(), picked(square()));
  EXPECT_LT(report.error_m.mean, 1e-12);
  EXPECT_LT(report.leaveOneOut_m->mean, 1e-12);
  EXPECT_NEAR(report.meanSigma_m, 0.011, 1e-12);
  EXPECT_LT((report.T_world_map.inverse().matrix() - kMapFromWorld.matrix()).norm(), 1e-11);
}

TEST(ControlPoints, MiddleLifted_SpreadsOverAllAndShowsInFullWhenLeftOut) {
  // The middle picked 0.5 m too high: by symmetry no tilt, the alignment sinks by the mean 0.1 m, so the corners are
  // 0.1 m off and the middle 0.4 m. Left out, the middle is predicted exactly: 0.5 m.
  auto points = square();
  points[4].position.z() += 0.5;
  const ControlReport report = evaluateControlPoints(square(), picked(points));
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(report.points[static_cast<std::size_t>(i)].error_m, 0.1, 1e-12);
  EXPECT_NEAR(report.points[4].error_m, 0.4, 1e-12);
  EXPECT_NEAR(report.points[4].residual_m.z(), 0.4, 1e-12);
  EXPECT_NEAR(*report.points[4].leaveOneOut_m, 0.5, 1e-12);
  EXPECT_NEAR(report.error_m.mean, 0.16, 1e-12);
  // Sample standard deviation of {0.1 x 4, 0.4} is 0.3 / sqrt(5); t(0.975, 4) = 2.776 (table, three decimals).
  EXPECT_NEAR(report.error_m.halfWidth, 2.776 * 0.3 / 5, 1e-4);
  EXPECT_GT(report.leaveOneOut_m->mean, report.error_m.mean);
}

TEST(ControlPoints, StretchedMap_GivesTheMeanStretch) {
  // 1 % too large about the middle: corners 0.01 * sqrt(200) off, the middle not at all.
  auto points = square();
  for (auto& point : points) point.position.head<2>() *= 1.01;
  const ControlReport report = evaluateControlPoints(square(), picked(points));
  EXPECT_NEAR(report.error_m.mean, 0.8 * 0.01 * std::sqrt(200.0), 1e-12);
}

TEST(ControlPoints, PointNotPicked_IsNamedAndTakesNoPart) {
  auto picks = picked(square());
  picks.erase(picks.begin() + 1);
  const ControlReport report = evaluateControlPoints(square(), picks);
  EXPECT_EQ(report.points.size(), 4u);
  EXPECT_EQ(report.notPicked, std::vector<std::string>{"b"});
}

TEST(ControlPoints, ThreePoints_HaveNoLeaveOneOut) {
  auto picks = picked(square());
  picks.resize(3);
  const ControlReport report = evaluateControlPoints(square(), picks);
  EXPECT_FALSE(report.leaveOneOut_m.has_value());
  EXPECT_FALSE(report.points[0].leaveOneOut_m.has_value());
}

TEST(ControlPoints, PointThatAloneFixesTheRotation_HasNoLeaveOneOut) {
  std::vector<NamedPoint> points = {{"1", {0, 0, 0}}, {"2", {10, 0, 0}}, {"3", {20, 0, 0}}, {"off", {5, 8, 0}}};
  const ControlReport report = evaluateControlPoints(points, picked(points));
  EXPECT_FALSE(report.points[3].leaveOneOut_m.has_value());
  EXPECT_TRUE(report.points[0].leaveOneOut_m.has_value());
}

TEST(ControlPoints, TwoPicks_AreRefusedWithTheReason) {
  auto picks = picked(square());
  picks.resize(2);
  try {
    evaluateControlPoints(square(), picks);
    FAIL() << "no error";
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("fewer than three"), std::string::npos) << e.what();
  }
}

TEST(ControlPoints, PointsOnALine_AreRefusedWithTheReason) {
  std::vector<NamedPoint> line;
  for (int i = 0; i < 5; ++i) line.push_back({std::to_string(i), {30.0 * i, 1e-3 * i * i, 2}, 0});
  try {
    evaluateControlPoints(line, picked(line));
    FAIL() << "no error";
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("on one line"), std::string::npos) << e.what();
  }
}

TEST(ControlPoints, PickOfUnknownId_IsRefused) {
  auto picks = picked(square());
  picks[0].id = "A";
  EXPECT_THROW(evaluateControlPoints(square(), picks), core::InputError);
}

TEST(NamedPoints, File_IsReadWithAndWithoutSigma) {
  const ScratchFolder folder;
  const auto points =
      readNamedPoints(folder.write("c.csv", "# surveyed\nid, x, y, z, sigma\ncp1, 1.5,-2,3e1,0.011\n\n"));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].id, "cp1");
  EXPECT_EQ(points[0].position, Eigen::Vector3d(1.5, -2, 30));
  EXPECT_EQ(points[0].sigma_m, 0.011);
  EXPECT_EQ(readNamedPoints(folder.write("p.csv", "\xEF\xBB\xBFid,x,y,z\r\n7,0,0,0\r\n"))[0].id, "7") << "from Excel";
}

TEST(NamedPoints, DamagedFiles_AreRefusedWithFileAndLine) {
  const ScratchFolder folder;
  const auto expectError = [&](const std::string& text, const std::string& part) {
    const std::string path = folder.write("bad.csv", text);
    try {
      readNamedPoints(path);
      FAIL() << "no error for " << text;
    } catch (const core::InputError& e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  };
  expectError("", "no column 'id'");
  expectError("id,x,y\na,1,2\n", "no column 'z'");
  expectError("id,x,y,z\na,1,2,3\nb,1,2\n", "bad.csv:3");
  expectError("id,x,y,z\na,1,2,3m\n", "'3m'");
  expectError("id,x,y,z\na,1,2,nan\n", "no number");
  expectError("id,x,y,z\na,1,2,3\na,1,2,3\n", "stands twice");
  EXPECT_THROW(readNamedPoints(folder.path("absent.csv")), core::InputError);
}
