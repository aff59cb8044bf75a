#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <tbb/global_control.h>

#include "s2s/core/error.h"
#include "s2s/obs/rawlog_reader.h"
#include "s2s/obs/rawlog_writer.h"
#include "s2s/sim/survey_simulator.h"
#include "s2s/sim/truth_writer.h"
#include "sim_support.h"
#include "temp_folder.h"

using namespace s2s;
using namespace s2s::test;

namespace {

sim::Scene smallScene() {
  sim::Scene scene = sceneOf({makeFloor(-3, 60), moved(sim::makeBox({30, 1, 12}), 10, 8, 0)});
  sim::Experiment e;
  e.number = 1;
  e.description = "straight";
  e.waypoints_m = {{0, 0}, {30, 0}};
  scene.experiments.push_back(e);
  scene.controlPoints.push_back({"P", {1, 2, 3}});
  return scene;
}

/// Small devices, so that a test takes a moment.
sim::SimulationOptions smallOptions() {
  sim::SimulationOptions o;
  o.duration_s = 2.2;
  o.lidar.rows = 8;
  o.lidar.columns = 64;
  o.sonarHorizontal.beamCount = 32;
  o.sonarHorizontal.rangeCount = 100;
  o.sonarVertical.beamCount = 16;
  o.sonarVertical.rangeCount = 100;
  return o;
}

struct Result {
  std::vector<mrpt::obs::CObservation::Ptr> records;
  std::vector<sim::PingTruth> truths;
  sim::SimulationSummary summary;

  std::string bytes() const {
    mrpt::io::CMemoryStream stream;
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& record : records) archive << *record;
    return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
  }
  std::size_t count(const std::string& label) const {
    return static_cast<std::size_t>(
        std::count_if(records.begin(), records.end(), [&](const auto& r) { return r->sensorLabel == label; }));
  }
};

Result simulate(const sim::SimulationOptions& options, std::size_t threads = 2) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const sim::Scene scene = smallScene();
  const sim::SurveySimulator simulator(scene, 1, options);
  Result result;
  sim::SimulationSinks sinks;
  sinks.record = [&](const auto& record) { result.records.push_back(record); };
  sinks.returnsHorizontal = [&](const auto& truth) { result.truths.push_back(truth); };
  result.summary = simulator.run(sinks);
  return result;
}

core::TimeNs timeOf(const mrpt::obs::CObservation::Ptr& record) { return core::fromMrptTime(record->timestamp); }

}  // namespace

TEST(SurveySimulator, AllSensors_DeliverAtTheirRates_InOrder) {
  const Result r = simulate(smallOptions());
  EXPECT_EQ(r.summary.imuSamples, 220u);
  EXPECT_EQ(r.count("LIDAR"), 22u);  // the last one ends with the survey
  EXPECT_NEAR(static_cast<double>(r.count("SONAR_HORIZONTAL")), 2.2 * 15, 1);
  EXPECT_NEAR(static_cast<double>(r.count("SONAR_VERTICAL")), 2.2 * 10, 1);
  EXPECT_EQ(r.summary.fixes, 3u);
  EXPECT_EQ(r.truths.size(), r.count("SONAR_HORIZONTAL"));
  for (std::size_t i = 1; i < r.records.size(); ++i) EXPECT_LE(r.records[i - 1]->timestamp, r.records[i]->timestamp);
  EXPECT_EQ(timeOf(r.records.front()), smallOptions().startTime);
}

TEST(SurveySimulator, SameSeed_SameBytes_WithAnyNumberOfThreads) {
  const std::string one = simulate(smallOptions(), 1).bytes();
  EXPECT_EQ(one, simulate(smallOptions(), 4).bytes());
  sim::SimulationOptions other = smallOptions();
  other.seed = 2;
  EXPECT_NE(one, simulate(other).bytes());
}

TEST(SurveySimulator, ShorterSurvey_IsTheBeginningOfTheLonger) {
  sim::SimulationOptions half = smallOptions();
  half.duration_s = 1;
  const std::string longer = simulate(smallOptions()).bytes(), shorter = simulate(half).bytes();
  // Only records that reach beyond the shorter survey's end are missing there.
  EXPECT_EQ(shorter.substr(0, shorter.size() / 2), longer.substr(0, shorter.size() / 2));
}

TEST(SurveySimulator, Faults_DropSilenceAndShiftRecords) {
  sim::SimulationOptions o = smallOptions();
  o.faults.imu.dropShare = 0.5;
  o.faults.sonarHorizontal.silentFrom_s = 0.5;
  o.faults.sonarHorizontal.silentFor_s = 1;
  o.faults.lidar.timeOffset_s = 0.25;
  const Result clean = simulate(smallOptions()), faulty = simulate(o);
  EXPECT_NEAR(static_cast<double>(faulty.count("IMU")), 110, 30);  // four binomial standard deviations
  EXPECT_EQ(clean.count("SONAR_HORIZONTAL") - faulty.count("SONAR_HORIZONTAL"), 15u);
  const auto firstSweep = [](const Result& r) {
    return *std::find_if(r.records.begin(), r.records.end(), [](const auto& x) { return x->sensorLabel == "LIDAR"; });
  };
  EXPECT_EQ(timeOf(firstSweep(faulty)) - timeOf(firstSweep(clean)), 250'000'000);
}

TEST(SurveySimulator, ClockJump_MovesAllTimesAfterIt) {
  sim::SimulationOptions o = smallOptions();
  o.faults.clockJumpAt_s = 1;
  o.faults.clockJump_s = -5;
  const Result r = simulate(o);
  const auto backwards =
      std::count_if(r.records.begin() + 1, r.records.end(), [&](const auto& x) { return timeOf(x) < o.startTime; });
  EXPECT_GT(backwards, 100);
}

TEST(SurveySimulator, SpoofedGnss_DriftsAway) {
  sim::SimulationOptions o = smallOptions();
  o.gnss.noise_m = o.gnss.wander_m = 0;
  const auto lastFix = [](const Result& r) {
    for (auto it = r.records.rbegin(); it != r.records.rend(); ++it)
      if (auto gps = std::dynamic_pointer_cast<mrpt::obs::CObservationGPS>(*it)) return gps;
    return mrpt::obs::CObservationGPS::Ptr();
  };
  const auto honest = lastFix(simulate(o))->getMsgByClass<mrpt::obs::gnss::Message_NMEA_GGA>();
  o.faults.spoofFrom_s = 1.1;
  o.faults.spoofDrift_mps = 10;
  o.faults.spoofDirection_rad = M_PI / 2;  // north
  const auto spoofed = lastFix(simulate(o))->getMsgByClass<mrpt::obs::gnss::Message_NMEA_GGA>();
  // The last fix comes at 2.1 s: 10 m north, at 111.3 km a degree of latitude there.
  EXPECT_NEAR((spoofed.fields.latitude_degrees - honest.fields.latitude_degrees) * 111'300, 10, 0.05);
  EXPECT_NEAR(spoofed.fields.longitude_degrees, honest.fields.longitude_degrees, 1e-12);
}

TEST(SurveySimulator, MountingError_ChangesTheDataButNotTheRecordedPose) {
  sim::SimulationOptions o = smallOptions();
  const Result clean = simulate(o);
  o.mountingErrors.sonarHorizontal = core::isometryFromXyzYpr(0.05, 0, 0, 0.03, 0, 0);
  const Result wrong = simulate(o);
  ASSERT_EQ(clean.truths.size(), wrong.truths.size());
  mrpt::poses::CPose3D a, b;
  const auto sonarOf = [](const Result& r) {
    return *std::find_if(r.records.begin(), r.records.end(),
                         [](const auto& x) { return x->sensorLabel == "SONAR_HORIZONTAL"; });
  };
  sonarOf(clean)->getSensorPose(a);
  sonarOf(wrong)->getSensorPose(b);
  EXPECT_EQ(a, b);
  EXPECT_NE(clean.bytes(), wrong.bytes());
}

TEST(TruthWriter, Files_HoldTheWorldTheWayAndTheMountings) {
  const TempFolder folder;
  const sim::Scene scene = smallScene();
  const sim::SimulationOptions o = smallOptions();
  const sim::SurveySimulator simulator(scene, 1, o);
  sim::writeTruth(folder.path(), scene, o, simulator.motion(), simulator.duration_s());
  const auto mesh = sim::loadMesh(folder.file("world.ply"));
  EXPECT_EQ(mesh.triangles.size(), scene.objects[0].mesh.triangles.size() + scene.objects[1].mesh.triangles.size());
  const std::string trajectory = readBytes(folder.file("trajectory.tum"));
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 1 + 221);  // a comment and 100 Hz over 2.2 s
  EXPECT_NE(readBytes(folder.file("extrinsics.ini")).find("[SONAR_VERTICAL]"), std::string::npos);
  EXPECT_NE(readBytes(folder.file("control_points.csv")).find("id,x,y,z,sigma\nP,"), std::string::npos);
  EXPECT_NE(readBytes(folder.file("objects.csv")).find("1,object1,object,grey"), std::string::npos);
  EXPECT_EQ(readBytes(folder.file("seabed.asc")).substr(0, 5), "ncols");
}

TEST(PingTruth, WrittenReturns_ReadBackTheSame_AndACutFileIsRefused) {
  const TempFolder folder;
  const Result r = simulate(smallOptions());
  const std::string path = folder.file("returns.bin");
  sim::PingTruthWriter writer(path);
  for (const auto& truth : r.truths) writer.write(truth);
  writer.close();
  sim::PingTruthReader reader(path);
  sim::PingTruth ping;
  for (const auto& truth : r.truths) {
    ASSERT_TRUE(reader.next(ping));
    EXPECT_EQ(ping.time, truth.time);
    EXPECT_EQ(ping.pingId, truth.pingId);
    ASSERT_EQ(ping.returns.size(), truth.returns.size());
    for (std::size_t i = 0; i < ping.returns.size(); ++i) EXPECT_EQ(ping.returns[i].x, truth.returns[i].x);
  }
  EXPECT_FALSE(reader.next(ping));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 3);
  sim::PingTruthReader cut(path);
  EXPECT_THROW(while (cut.next(ping)){}, core::InputError);
  EXPECT_THROW(sim::PingTruthReader(folder.file("none.bin")), core::InputError);
}

TEST(GnssModel, Fix_IsTheAntennasPlaceOnTheEllipsoid) {
  sim::GnssOptions o;
  o.noise_m = o.wander_m = 0;
  o.T_vehicle_antenna = core::Isometry::Identity();
  o.originLatitude_deg = 0;
  o.originLongitude_deg = 10;
  sim::Experiment e;
  e.waypoints_m = {{1000, 500}, {1100, 500}};
  sim::WaveOptions still;
  still.enabled = false;
  const sim::VesselMotion motion(e, {}, still, 1);
  sim::GnssModel gnss(o, 1);
  const auto fix = gnss.fix(motion, 0, 0)->getMsgByClass<mrpt::obs::gnss::Message_NMEA_GGA>();
  // On the equator a degree of longitude is pi a / 180, one of latitude pi a (1 - e^2) / 180.
  EXPECT_NEAR(fix.fields.longitude_degrees, 10 + 1000 / (M_PI * 6378137.0 / 180), 1e-9);
  EXPECT_NEAR(fix.fields.latitude_degrees, 500 / (M_PI * 6378137.0 * (1 - 0.00669437999014) / 180), 1e-9);
}
