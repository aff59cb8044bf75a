#include <gtest/gtest.h>

#include <random>

#include "s2s/core/error.h"
#include "s2s/eval/map_entropy.h"
#include "s2s/eval/pass_difference.h"
#include "s2s/eval/quality_report.h"
#include "s2s/eval/report_json.h"
#include "s2s/eval/report_text.h"
#include "sample_survey.h"

using namespace s2s;
using namespace s2s::eval;

TEST(MapEntropy, GaussianCloud_HasTheEntropyOfItsDistribution) {
  const Eigen::Vector3d sigma(0.05, 0.03, 0.01), centre(100, -40, 3);
  MapEntropy entropy({centre}, 1.0);
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20000; ++i)
    entropy.add(centre + Eigen::Vector3d(normal(random), normal(random), normal(random)).cwiseProduct(sigma));
  const CloudCrispness crispness = entropy.result();
  EXPECT_EQ(crispness.evaluated, 1u);
  // 1/2 ln det(2 pi e C); each variance of 20000 samples is known to 1 %, so its half logarithm to 0.005.
  const double closed = 1.5 * (std::log(2 * M_PI) + 1) + std::log(sigma.prod());
  EXPECT_NEAR(crispness.meanEntropy, closed, 0.02);
  EXPECT_NEAR(crispness.planeSigma_m.median, 0.01, 0.0003);
}

TEST(MapEntropy, PointsFarAndNear_OnlyThoseWithinTheRadiusCount) {
  MapEntropy entropy({{0, 0, 0}}, 0.5);
  for (int i = 0; i < 9; ++i) entropy.add({0.01 * i, 0, 0});
  for (int i = 0; i < 50; ++i) entropy.add({0.5 + 0.001 * (i + 1), 0, 0});
  EXPECT_EQ(entropy.result().evaluated, 0u);  // nine neighbours are too few
  entropy.add({-0.4, -0.1, 0.2});
  EXPECT_EQ(entropy.result().evaluated, 1u);
}

TEST(MapEntropy, PlaceAcrossCellBorders_SeesAllItsNeighbours) {
  // A place in the corner of eight cells, with two neighbours in each of them.
  MapEntropy entropy({{0.001, 0.001, 0.001}}, 0.3);
  for (int n = 0; n < 16; ++n) entropy.add(0.1 * Eigen::Vector3d(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1));
  EXPECT_EQ(entropy.result().evaluated, 1u);
}

TEST(PassComparison, SecondPassTenCentimetresHigher_IsTheDifference) {
  products::HeightGrid grid(0, 0, 0.5, 10, 10);
  for (auto& height : grid.height_m) height = -4;
  PassComparison passes(grid, {});
  for (int i = 0; i < 100; ++i) {
    const double x = 0.05 * i + 0.01;
    passes.add({x, 0.2, -4}, 1000 + 0.1 * i);
    if (x < 2.5) passes.add({x, 0.2, -3.9}, 1300 + 0.1 * i);
    passes.add({x, 0.2, -1}, 1600);  // no seabed
    passes.add({x, 7, -4}, 1600);    // beside the grid
  }
  const PassDifference difference = passes.result();
  EXPECT_EQ(difference.cells, 5u);
  EXPECT_EQ(difference.differences, 5u);
  EXPECT_NEAR(difference.mean_m, 0.1, 1e-12);
  EXPECT_NEAR(difference.p95_m, 0.1, 1e-12);
  EXPECT_NEAR(difference.std_m, 0, 1e-12);
}

TEST(PassComparison, SlowPassWithoutGap_IsOnePass) {
  products::HeightGrid grid(0, 0, 0.5, 1, 1);
  grid.height_m[0] = -4;
  PassComparison passes(grid, {});
  for (int i = 0; i < 200; ++i) passes.add({0.2, 0.2, -4 + 0.001 * i}, 1000 + i);
  EXPECT_EQ(passes.result().cells, 0u);
}

TEST(PassComparison, PassWithTooFewSoundings_IsNone) {
  products::HeightGrid grid(0, 0, 0.5, 1, 1);
  grid.height_m[0] = -4;
  PassComparison passes(grid, {});
  for (int i = 0; i < 20; ++i) passes.add({0.2, 0.2, -4}, 1000);
  for (int i = 0; i < 4; ++i) passes.add({0.2, 0.2, -3.9}, 2000);
  EXPECT_EQ(passes.result().differences, 0u);
}

TEST(QualityReport, SampleSurvey_IsMeasured) {
  const ScratchFolder folder;
  const SampleSurvey survey(folder);
  survey.writeMap(0);
  const QualityReport report = evaluateQuality(survey.out(), {});
  EXPECT_EQ(report.points.at(map::Layer::Lidar), 4000u);
  // LiDAR points lie on a plane: nothing but the floor of 1 mm across it.
  EXPECT_NEAR(report.crispness.at(map::Layer::Lidar).planeSigma_m.max, 0.001, 1e-9);
  ASSERT_TRUE(report.seabed.has_value());
  EXPECT_EQ(report.seabed->soundings.median, 9);
  EXPECT_NEAR(report.seabed->sigma_m.median, 0.06, 1e-6);
  EXPECT_NEAR(report.seabed->area_m2, 36 * 36 - 4 * 5, 10);  // edges cut askew
  EXPECT_EQ(report.notes.size(), 1u);                        // line_vertical
  EXPECT_EQ(toJson(report).at("seabed").at("cells"), report.seabed->cells);
  EXPECT_NE(toText(report).find("no cell was passed twice"), std::string::npos);
}

TEST(QualityReport, NoMap_IsRefused) {
  const ScratchFolder folder;
  EXPECT_THROW(evaluateQuality(folder.path(), {}), core::InputError);
}
