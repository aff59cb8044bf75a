#include "s2s/eval/truth_report.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "s2s/core/error.h"
#include "s2s/eval/report_json.h"
#include "s2s/eval/report_text.h"
#include "s2s/eval/truth_folder.h"
#include "s2s/eval/wall_report.h"
#include "sample_survey.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

class TruthReportTest : public testing::Test {
 protected:
  TruthReportTest() : survey_(folder_) {
    survey_.writeTruth();
    survey_.writeMap(0);
  }

  TruthReport evaluate() const { return evaluateAgainstTruth(survey_.out(), survey_.truth(), {}); }

  void expectRefusal(const std::string& part) const {
    try {
      evaluate();
      FAIL() << "no error";
    } catch (const core::InputError& e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("what to do"), std::string::npos) << e.what();
    }
  }

  ScratchFolder folder_;
  SampleSurvey survey_;
};

}  // namespace

TEST_F(TruthReportTest, MapMadeFromTheTruth_HasNoErrors) {
  const TruthReport report = evaluate();
  ASSERT_EQ(report.trajectories.size(), 2u);
  // Files hold positions to 1 nm and quaternions to about as many decimals.
  EXPECT_LT(report.trajectories[0].absolute.translation_m.max, 1e-7);
  EXPECT_LT(report.trajectories[0].absolute.rotation_rad.max, 1e-6);
  EXPECT_LT(report.trajectories[0].rotationByPoses_rad.max, 1e-6);
  EXPECT_LT(report.trajectories[0].relative[0].error.translation_m.max, 1e-7);
  EXPECT_LT((report.T_world_map.matrix() - SampleSurvey::T_map_world().inverse().matrix()).norm(), 1e-6);
  // 1e-6 of attitude over the 30 m of the scene.
  EXPECT_LT(report.layers.at(map::Layer::Lidar).distance_m.max, 1e-4);
  EXPECT_LT(report.layers.at(map::Layer::Stereo).distance_m.max, 1e-4);
  EXPECT_EQ(report.layers.at(map::Layer::Stereo).within5cm, 1);
  ASSERT_EQ(report.media.size(), 2u);
  EXPECT_EQ(report.media[0].precision5cm, 1);
  EXPECT_EQ(report.media[1].precision5cm, 1);
  EXPECT_GT(report.media[1].recall.within20cm, report.media[1].recall.within5cm);
  ASSERT_TRUE(report.seabed.has_value());
  EXPECT_EQ(report.seabed->withoutTruth, 0u);
  EXPECT_LT(report.seabed->max_m, 1e-4);
  EXPECT_EQ(report.seabed->withinOrder[0], 1);
  EXPECT_NEAR(report.seabed->meanDepth_m, 4,
              0.05);  // the slope is even about the middle, but for the box's surroundings
}

TEST_F(TruthReportTest, MapTenCentimetresTooHigh_ShowsTheTenCentimetres) {
  survey_.writeMap(0.1);
  const TruthReport report = evaluate();
  EXPECT_NEAR(report.seabed->bias_m, 0.1, 1e-4);
  EXPECT_NEAR(report.seabed->rmse_m, 0.1, 1e-4);
  EXPECT_NEAR(report.seabed->p95_m, 0.1, 1e-4);
  EXPECT_EQ(report.seabed->withinOrder[0], 1);  // 0.153 m at 4 m depth
  EXPECT_EQ(report.seabed->withinTwoSigma, 1);  // twice 0.06 m
  // Stereo points above a bed that slopes by 2 % are 0.1 cos(atan 0.02) off; those of the box too.
  EXPECT_NEAR(report.layers.at(map::Layer::Stereo).distance_m.median, 0.1, 1e-4);
  EXPECT_LT(report.layers.at(map::Layer::Stereo).within5cm, 0.01);
  // The upright wall does not see it.
  EXPECT_LT(report.layers.at(map::Layer::Lidar).distance_m.max, 1e-4);
}

TEST_F(TruthReportTest, MapThirtyCentimetresTooHigh_LeavesTheOrders) {
  survey_.writeMap(0.3);
  const TruthReport report = evaluate();
  EXPECT_EQ(report.seabed->withinOrder[0], 0);  // 0.153 m
  EXPECT_EQ(report.seabed->withinOrder[1], 0);  // 0.252 m
  EXPECT_EQ(report.seabed->withinOrder[2], 1);  // 0.503 m
  EXPECT_EQ(report.seabed->withinTwoSigma, 0);
}

TEST_F(TruthReportTest, GridWithAHole_IsCoveredButForTheHole) {
  const SeabedError seabed = *evaluate().seabed;
  // The grid lacks 4 m x 5 m about the box, all within 5 m of the path; cells of 0.25 m² cut askew at the hole's edge
  // make half a cell about its 18 m uncertain. Cells' edges elsewhere are covered.
  const double missing = (1 - seabed.coverage) * static_cast<double>(seabed.trueCells) * 0.25;
  EXPECT_NEAR(missing, 20, 18 * 0.5 * 0.5);
  EXPECT_LT(seabed.coverage, 1);
}

TEST_F(TruthReportTest, PointsOnTheBox_AreCountedAsItsOwn) {
  const TruthReport report = evaluate();
  ASSERT_EQ(report.objects.size(), 1u);
  const ObjectPresence& box = report.objects[0];
  EXPECT_EQ(box.name, "chest");
  const auto stereo = static_cast<std::size_t>(map::Layer::Stereo);
  EXPECT_GE(box.own[stereo], 50u);
  EXPECT_GE(box.near[stereo], box.own[stereo]);
  EXPECT_EQ(box.near[static_cast<std::size_t>(map::Layer::Lidar)], 0u);
  // Its top at -3.3 m stands 0.62 to 0.60 m above the bed of -3.92 to -3.9 m.
  EXPECT_NEAR(box.trueHeight_m, 0.62, 1e-5);
  EXPECT_NEAR(box.mappedHeight_m, 0.61, 0.011);
}

TEST_F(TruthReportTest, SampledLayer_SaysSo) {
  TruthOptions options;
  options.maxPointsPerLayer = 1000;
  const TruthReport report = evaluateAgainstTruth(survey_.out(), survey_.truth(), options);
  const LayerDistance& lidar = report.layers.at(map::Layer::Lidar);
  EXPECT_EQ(lidar.points, 4000u);
  EXPECT_LE(lidar.sampled, 1000u);
  EXPECT_GE(lidar.sampled, 400u);
}

TEST_F(TruthReportTest, AbsentFiles_AreNotedOrRefused) {
  std::filesystem::remove(folder_.path("out/odometry.tum"));
  std::filesystem::remove(folder_.path("out/seabed.tif"));
  const TruthReport report = evaluate();
  EXPECT_EQ(report.trajectories.size(), 1u);
  EXPECT_FALSE(report.seabed.has_value());
  EXPECT_EQ(report.layers.count(map::Layer::LineVertical), 0u);
  EXPECT_EQ(report.notes.size(), 3u);  // odometry, seabed, line_vertical
  std::filesystem::remove(folder_.path("out/trajectory.tum"));
  expectRefusal("no trajectory.tum");
}

TEST_F(TruthReportTest, DamagedTruth_IsRefused) {
  folder_.write("truth/objects.csv", "id,name,kind,material\n0,bed,seabed,sand\n1,quay,wall,stone\n");
  expectRefusal("object 2");
  std::filesystem::remove(folder_.path("truth/world.ply"));
  expectRefusal("no world.ply");
}

TEST_F(TruthReportTest, Rubble_IsGroundUnderWaterAndNoObjectToBeFound) {
  const auto groundWith = [&](const std::string& kind) {
    folder_.write("truth/objects.csv",
                  "id,name,kind,material\n0,bed,seabed,sand\n1,quay,wall,stone\n2,blocks," + kind + ",stone\n");
    return MeshQuery(readTruthFolder(survey_.truth()).groundUnderWater());
  };
  const double bed_m = SampleSurvey::seabedHeight(4.5, 5);
  EXPECT_NEAR(groundWith("rubble").topHeight_m(4.5, 5).value(), SampleSurvey::kBoxTop, 1e-6);
  EXPECT_TRUE(evaluate().objects.empty());
  EXPECT_NEAR(groundWith("structure").topHeight_m(4.5, 5).value(), bed_m, 1e-6);
  EXPECT_NEAR(groundWith("object").topHeight_m(4.5, 5).value(), SampleSurvey::kBoxTop, 1e-6);
  EXPECT_EQ(evaluate().objects.size(), 1u);
}

TEST_F(TruthReportTest, TrajectoriesOfDifferentDays_AreRefused) {
  folder_.write("out/trajectory.tum", "100 0 0 0 0 0 0 1\n101 1 0 0 0 0 0 1\n");
  expectRefusal("no time in common");
}

TEST_F(TruthReportTest, Json_HoldsTheFiguresOfTheReport) {
  const TruthReport report = evaluate();
  const auto json = toJson(report);
  EXPECT_EQ(json.at("trajectory").at("ate_m").at("rmse"), report.trajectories[0].absolute.translation_m.rmse);
  EXPECT_EQ(json.at("odometry").at("pairs"), report.trajectories[1].pairs);
  EXPECT_EQ(json.at("layers").at("stereo").at("within_5cm"), 1);
  EXPECT_EQ(json.at("layers").at("lidar").at("distance_m").at("median"),
            report.layers.at(map::Layer::Lidar).distance_m.median);
  EXPECT_EQ(json.at("seabed").at("within_order").at("Exclusive"), 1);
  EXPECT_EQ(json.at("objects").at(0).at("name"), "chest");
  // Every number survives printing and reading.
  EXPECT_EQ(nlohmann::ordered_json::parse(json.dump()), json);
}

TEST_F(TruthReportTest, Text_NamesEachPart) {
  const std::string text = toText(evaluate());
  for (const char* part : {"ATE rmse [m]", "RPE", "segment error", "stereo", "seabed height", "Exclusive", "chest"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(TruthReportTest, QuayInWorldCoordinates_IsAPlaneAboveAndBelowTheWater) {
  WallReportOptions options;
  options.wall.from_m = {-15, 20};
  options.wall.to_m = {15, 20};
  options.wall.halfWidth_m = 0.5;
  options.sonarLayers = {map::Layer::LineHorizontal};
  options.truthFolder = survey_.truth();
  const WallReport report = evaluateWall(survey_.out(), options);
  EXPECT_LT(report.lidar.width_m, 1e-3);  // the points lie on the plane y = 20, the alignment is good to 1e-6 rad
  EXPECT_LT(report.sonar.width_m, 1e-3);
  EXPECT_NEAR(report.shift_m, 0, 1e-3);
  EXPECT_NEAR(report.T_wall_map.inverse().translation().z(), 0, 1e-4);  // the water, in world coordinates
}

TEST_F(TruthReportTest, WallWithoutWaterHeight_IsRefused) {
  std::filesystem::remove(folder_.path("out/summary.json"));
  WallReportOptions options;
  options.wall.from_m = {-15, 20};
  options.wall.to_m = {15, 20};
  EXPECT_THROW(evaluateWall(survey_.out(), options), core::InputError);
}
