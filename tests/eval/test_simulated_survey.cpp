#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <memory>

#include "s2s/core/trajectory.h"
#include "s2s/eval/control_points.h"
#include "s2s/eval/target_picker.h"
#include "s2s/eval/truth_report.h"
#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/obs/rawlog_reader.h"
#include "s2s/obs/sweep_projector.h"
#include "s2s/products/ply_writer.h"
#include "s2s/products/trajectory_files.h"
#include "scratch_folder.h"

using namespace s2s;
using namespace s2s::eval;

namespace {

/// A basin of 40 m x 30 m with a quay around it and four boards on the quay.
constexpr const char* kScene = R"(
[scene]
name = basin
[seabed]
height_m = -4
[object.bed]
shape = terrain
kind = seabed
material = mud
min_x_m = -20
max_x_m = 20
min_y_m = -15
max_y_m = 15
resolution_m = 0.5
[object.north]
shape = box
kind = wall
material = stone
pose = 0 15.5 -1 0 0 0
size_x_m = 42
size_y_m = 1
size_z_m = 8
[object.south]
shape = box
kind = wall
material = stone
pose = 0 -15.5 -1 0 0 0
size_x_m = 42
size_y_m = 1
size_z_m = 8
[object.east]
shape = box
kind = wall
material = stone
pose = 20.5 0 -1 0 0 0
size_x_m = 1
size_y_m = 30
size_z_m = 8
[control_point.1]
x_m = 5
y_m = 14.7
z_m = 1.5
board_yaw_deg = 90
[control_point.2]
x_m = -6
y_m = 14.7
z_m = 2.0
board_yaw_deg = 90
[control_point.3]
x_m = 2
y_m = -14.7
z_m = 1.2
board_yaw_deg = 90
[control_point.4]
x_m = 19.7
y_m = 3
z_m = 1.8
[experiment.1]
description = straight
waypoints_m = -8 0 12 0
)";

core::Isometry T_map_world() { return core::isometryFromXyzYpr(-30, 80, -1.3, -0.9, 0, 0); }

/// Every return of a sweep in the world, by the true pose at its column's time.
void addSweep(const obs::CObservationLidarSweep& sweep, const core::Trajectory& truth,
              products::PlyPointWriter& writer) {
  obs::SweepProjector projector;
  projector.prepare(sweep);
  const core::TimeNs start = core::fromMrptTime(sweep.timestamp);
  const core::Isometry T_vehicle_sensor = core::toIsometry(sweep.sensorPose);
  for (std::size_t column = 0; column < sweep.columnCount; ++column) {
    const auto T_world_vehicle = truth.at(start + sweep.columnTime_ns[column]);
    if (!T_world_vehicle) continue;
    const core::Isometry T_map_sensor = T_map_world() * *T_world_vehicle * T_vehicle_sensor;
    for (std::size_t row = 0; row < sweep.rowCount; ++row) {
      const std::size_t pixel = row * sweep.columnCount + column;
      const std::uint32_t range = sweep.echoes[0].range[pixel];
      if (range == 0) continue;
      map::MapPoint point;
      point.p_map = T_map_sensor * projector.point(row, column, range).cast<double>();
      point.intensity = static_cast<float>(sweep.echoes[0].reflectivity[pixel]);
      writer.add(point);
    }
  }
}

/// Simulates a survey without LiDAR faults and makes a "map" of it by the true poses, in a frame of its own.
class SimulatedSurveyTest : public testing::Test {
 protected:
  SimulatedSurveyTest() {
    simulate();
    const core::Trajectory truth = products::readTum(folder_.path("sim/truth/trajectory.tum"));
    core::Trajectory map;
    for (std::size_t i = 0; i < truth.size(); i += 10)
      map.append(truth.poses()[i].time, T_map_world() * truth.poses()[i].T);
    products::writeTum(folder_.path("out/trajectory.tum"), map);
    products::PlyPointWriter lidar(folder_.path("out/lidar.ply"));
    obs::RawlogReader reader(folder_.path("sim/survey.rawlog"));
    while (const auto observation = reader.next())
      if (const auto sweep = std::dynamic_pointer_cast<obs::CObservationLidarSweep>(observation))
        addSweep(*sweep, truth, lidar);
    lidar.finish();
  }

  void simulate() const {
    const std::string scene = folder_.write("scene.ini", kScene);
    std::string command = std::string(S2S_BIN_DIR) + "/simulate-survey --scene " + scene + " --output " +
                          folder_.path("sim") + " --duration 5 --lidar 64x512@10";
    for (const char* setting : {"sonar.horizontal.enabled=false", "sonar.vertical.enabled=false", "lidar.noise=false",
                                "lidar.bias=false", "lidar.dropouts=false", "lidar.mixed_pixels=false",
                                "lidar.own_vessel=false", "lidar.water_returns=false", "lidar.water_ghosts=false"})
      command += std::string(" --set ") + setting;
    ASSERT_EQ(std::system((command + " > '" + folder_.path("log.txt") + "' 2>&1").c_str()), 0) << command;
  }

  ScratchFolder folder_;
};

}  // namespace

TEST_F(SimulatedSurveyTest, MapByTheTruePoses_LiesOnTheTrueSurfaces) {
  const TruthReport report = evaluateAgainstTruth(folder_.path("out"), folder_.path("sim/truth"), {});
  // Files hold positions to 1e-6 m and quaternions to 1e-9.
  EXPECT_LT(report.trajectories.at(0).absolute.translation_m.max, 1e-5);
  const LayerDistance& lidar = report.layers.at(map::Layer::Lidar);
  EXPECT_GT(lidar.points, 100000u);
  // Ranges are counted in millimetres; between true poses 10 ms apart the vessel's waves bend the path by far less.
  EXPECT_LT(lidar.distance_m.p95, 0.001);
  EXPECT_LT(lidar.distance_m.max, 0.005);
}

TEST_F(SimulatedSurveyTest, Boards_GiveTheControlPointError) {
  PickOptions options;
  options.pointsFile = folder_.path("sim/truth/control_points.csv");
  options.truthFolder = folder_.path("sim/truth");
  const auto picks = pickTargets(folder_.path("out"), options);
  ASSERT_EQ(picks.size(), 4u);
  for (const auto& pick : picks) EXPECT_TRUE(pick.found) << pick.id;
  const std::string picksFile = folder_.write("picks.csv", picksCsv(picks));
  const ControlReport report = evaluateControlPoints(readNamedPoints(options.pointsFile), readNamedPoints(picksFile));
  // Control points are known to 0.011 m an axis; beams are 0.7° apart, 0.18 m at 15 m, so that the edge of a board
  // is met to within about a third of that, moving with the vessel: some centimetres.
  EXPECT_LT(report.error_m.mean, 0.06);
  ASSERT_TRUE(report.leaveOneOut_m.has_value());
  EXPECT_LT(report.leaveOneOut_m->mean, 0.12);
}
