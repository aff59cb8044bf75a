#include <gtest/gtest.h>

#include <filesystem>

#include "s2s/core/error.h"
#include "s2s/sim/options_table.h"
#include "s2s/sim/scene_loader.h"
#include "sim_support.h"

using namespace s2s;
using namespace s2s::test;

namespace {

std::vector<std::string> shippedScenes() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(S2S_SOURCE_DIR "/share/scenes"))
    if (entry.path().extension() == ".ini") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

sim::Scene parse(const std::string& text) {
  core::IniFile ini = core::IniFile::parse("[scene]\nname = x\n[object.a]\nshape = sphere\n" + text, "test.ini");
  sim::Scene scene = sim::loadScene(ini);
  ini.rejectUnread();
  return scene;
}

class ShippedScene : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(ShippedScene, LoadsWithoutUnknownKeys_AndItsExperimentsKeepClearOfEverything) {
  core::IniFile ini = core::IniFile::load(GetParam());
  sim::SimulationOptions options;
  sim::loadSimulationOptions(ini, options);
  const sim::Scene scene = sim::loadScene(ini);
  ASSERT_NO_THROW(ini.rejectUnread());
  EXPECT_FALSE(scene.vesselParts.empty());
  ASSERT_FALSE(scene.experiments.empty());
  const sim::RayCaster caster(scene.objects);
  for (const auto& experiment : scene.experiments) {
    EXPECT_FALSE(experiment.description.empty());
    const sim::VesselMotion motion(experiment, options.vessel, options.waves, 1);
    EXPECT_LT(motion.duration_s(), 3600) << "the vessel does not reach the last waypoint";
    for (double t = 0; t < motion.duration_s(); t += 0.5) {
      const Eigen::Vector3f p = motion.pose(t).translation().cast<float>();
      for (int k = 0; k < 16; ++k) {  // half the vessel is 1 m long; half a metre of room around it
        const auto angle = static_cast<float>(k * M_PI / 8);
        const auto hit = caster.cast(sim::Ray{{p.x(), p.y(), 0.1f}, {std::cos(angle), std::sin(angle), 0}, 1.5f});
        ASSERT_FALSE(hit.hit()) << "experiment " << experiment.number << " at " << t << " s meets "
                                << scene.objects[hit.object].name;
      }
      const auto below = caster.cast(sim::Ray{{p.x(), p.y(), -0.1f}, {0, 0, -1}, 50});
      ASSERT_TRUE(below.hit()) << "no seabed below experiment " << experiment.number << " at " << t << " s";
      ASSERT_GT(below.range_m, 0.8) << "experiment " << experiment.number << " at " << t << " s runs aground on "
                                    << scene.objects[below.object].name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shippedScenes()),
                         [](const auto& scene) { return std::filesystem::path(scene.param).stem().string(); });

TEST(SceneLoader, UnknownShapeMaterialKeyOrKind_IsRefusedWithItsPlace) {
  const auto messageOf = [](const std::string& text) -> std::string {
    try {
      parse(text);
    } catch (const core::ConfigError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(messageOf("[object.b]\nshape = spere\n").find("[object.b] shape"), std::string::npos);
  EXPECT_NE(messageOf("[object.b]\nshape = box\nmaterial = concrte\n").find("concrete"), std::string::npos);
  EXPECT_NE(messageOf("[object.b]\nshape = box\nradius_m = 1\n").find("radius_m"), std::string::npos);
  EXPECT_NE(messageOf("[object.b]\nmaterial = sand\n").find("shape"), std::string::npos);
  EXPECT_NE(messageOf("[object.b]\nshape = wall\nline_m = 1 2 3\n").find("line_m"), std::string::npos);
  EXPECT_NE(messageOf("[experiment.one]\nwaypoints_m = 0 0 1 1\n").find("number"), std::string::npos);
}

TEST(SceneLoader, RepeatAndOnSeabed_PlaceCopies) {
  const sim::Scene scene = parse(
      "[seabed]\nheight_m = -4\nslope_x = 0.1\n"
      "[object.b]\nshape = box\nsize_x_m = 1\nsize_y_m = 1\nsize_z_m = 1\npose = 2 0 0.5 0 0 0\non_seabed = true\n"
      "repeat = 3\nrepeat_dx_m = 5\n");
  const auto& mesh = scene.objects[1].mesh;
  ASSERT_EQ(mesh.vertices.size(), 24u);
  for (int copy = 0; copy < 3; ++copy) {
    float low = 10;
    for (int i = 0; i < 8; ++i)
      low = std::min(low, mesh.vertices.at(8 * static_cast<std::size_t>(copy) + static_cast<std::size_t>(i)).z());
    EXPECT_NEAR(low, -4 + 0.1 * (2 + 5 * copy), 1e-5);
  }
}

TEST(SceneLoader, ControlPoint_GetsItsBoard_AndAMaterialCanBeRedefined) {
  const sim::Scene scene = parse(
      "[material.sand]\nbackscatter_db = -11\n[object.c]\nshape = box\nmaterial = sand\n"
      "[control_point.P]\nx_m = 1\ny_m = 2\nz_m = 3\nboard_yaw_deg = 90\n");
  ASSERT_EQ(scene.controlPoints.size(), 1u);
  const auto& board = scene.objects.back();
  EXPECT_EQ(board.name, "board_P");
  EXPECT_TRUE(scene.materials[board.material].retro);
  EXPECT_EQ(scene.materials[scene.objects[1].material].backscatter_db, -11);
}

TEST(SceneLoader, UnknownExperiment_ListsThoseThereAre) {
  const sim::Scene scene = parse("[experiment.2]\ndescription = lap\nwaypoints_m = 0 0 9 9\n");
  try {
    scene.experiment(7);
    FAIL();
  } catch (const core::ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("2  lap"), std::string::npos);
  }
}

TEST(SimulationOptions, Printed_ReadBackTheSame) {
  sim::SimulationOptions options;
  options.sonarHorizontal.taper = 0.61;
  options.faults.lidar.jitter_s = 0.002;
  const std::string text = sim::printSimulationOptions(options);
  core::IniFile ini = core::IniFile::parse(text, "printed.ini");
  sim::SimulationOptions read;
  sim::loadSimulationOptions(ini, read);
  ini.rejectUnread();
  EXPECT_EQ(sim::printSimulationOptions(read), text);
}
