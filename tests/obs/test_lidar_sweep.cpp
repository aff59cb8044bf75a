#include "s2s/obs/CObservationLidarSweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "s2s/core/error.h"
#include "sample_observations.h"

using namespace s2s;
using obs::CObservationLidarSweep;
using testing::HasSubstr;

namespace {

std::string faultAfter(const std::function<void(CObservationLidarSweep&)>& damage) {
  const auto sweep = test::sampleSweep();
  damage(*sweep);
  try {
    sweep->checkConsistent();
  } catch (const core::InputError& e) {
    return e.fault();
  }
  return "";
}

std::size_t bytesOf(const CObservationLidarSweep& sweep) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << sweep;
  return static_cast<std::size_t>(memory.getTotalBytesCount());
}

}  // namespace

TEST(LidarSweep, PixelTime_AddsColumnAndRow) {
  const auto sweep = test::sampleSweep();
  EXPECT_EQ(sweep->pixelTime_ns(1, 2), 60'000'250);
  sweep->rowTime_ns.clear();
  EXPECT_EQ(sweep->pixelTime_ns(1, 2), 60'000'000);
  sweep->columnTime_ns.clear();
  EXPECT_EQ(sweep->pixelTime_ns(1, 2), 0);
  EXPECT_EQ(sweep->duration_s(), 0);
}

TEST(LidarSweep, ColumnsStoredAgainstTime_LastAsLong) {
  const auto sweep = test::sampleSweep();
  const double duration_s = sweep->duration_s();
  std::reverse(sweep->columnTime_ns.begin(), sweep->columnTime_ns.end());
  EXPECT_EQ(sweep->duration_s(), duration_s) << "a negative one would put the sweep's end before its start";
}

TEST(LidarSweep, Counts_AreOfTheFirstEcho) {
  const auto sweep = test::sampleSweep();
  EXPECT_EQ(sweep->pixelCount(), 6u);
  EXPECT_EQ(sweep->returnCount(), 5u);
  EXPECT_DOUBLE_EQ(sweep->duration_s(), 0.06000025);
  EXPECT_FALSE(sweep->isColumnValid(1));
  sweep->columnValid.clear();
  EXPECT_TRUE(sweep->isColumnValid(1));
}

TEST(LidarSweep, ShortRanges_TakeTwoBytesEach) {
  auto sweep = test::sampleSweep();
  sweep->echoes.resize(1);
  sweep->echoes[0].range = {1, 2, 3, 4, 5, 65'535};
  const std::size_t narrow = bytesOf(*sweep);
  sweep->echoes[0].range.back() = 65'536;
  EXPECT_EQ(bytesOf(*sweep), narrow + 6 * 2);
}

TEST(LidarSweep, Sample_IsConsistent) {
  EXPECT_EQ(faultAfter([](auto&) {}), "");
}

TEST(LidarSweep, Contradictions_AreNamed) {
  EXPECT_THAT(faultAfter([](auto& s) { s.echoes.clear(); }), HasSubstr("echoes"));
  EXPECT_THAT(faultAfter([](auto& s) { s.rangeResolution_m = 0; }), HasSubstr("range resolution"));
  EXPECT_THAT(faultAfter([](auto& s) { s.rangeResolution_m = NAN; }), HasSubstr("range resolution"));
  EXPECT_THAT(faultAfter([](auto& s) { s.echoes[1].range.pop_back(); }), HasSubstr("range has 5 values, expected 6"));
  EXPECT_THAT(faultAfter([](auto& s) { s.echoes[0].reflectivity.pop_back(); }), HasSubstr("reflectivity"));
  EXPECT_THAT(faultAfter([](auto& s) { s.echoes[0].signal.pop_back(); }), HasSubstr("signal"));
  EXPECT_THAT(faultAfter([](auto& s) { s.echoes[0].flags.pop_back(); }), HasSubstr("flags"));
  EXPECT_THAT(faultAfter([](auto& s) { s.nearInfrared.pop_back(); }), HasSubstr("nearInfrared"));
  EXPECT_THAT(faultAfter([](auto& s) { s.beamAltitude_rad.clear(); }), HasSubstr("beamAltitude_rad"));
  EXPECT_THAT(faultAfter([](auto& s) { s.beamAzimuth_rad.pop_back(); }), HasSubstr("beamAzimuth_rad"));
  EXPECT_THAT(faultAfter([](auto& s) { s.columnAzimuth_rad.clear(); }), HasSubstr("columnAzimuth_rad"));
  EXPECT_THAT(faultAfter([](auto& s) { s.columnTime_ns.pop_back(); }), HasSubstr("columnTime_ns"));
  EXPECT_THAT(faultAfter([](auto& s) { s.rowTime_ns.pop_back(); }), HasSubstr("rowTime_ns"));
  EXPECT_THAT(faultAfter([](auto& s) { s.columnValid.pop_back(); }), HasSubstr("columnValid"));
}

TEST(LidarSweep, OptionalLayersAbsent_IsConsistent) {
  EXPECT_EQ(faultAfter([](auto& s) {
              s.echoes.resize(1);
              s.echoes[0].reflectivity.clear();
              s.echoes[0].signal.clear();
              s.echoes[0].flags.clear();
              s.nearInfrared.clear();
              s.beamAzimuth_rad.clear();
              s.columnTime_ns.clear();
              s.rowTime_ns.clear();
              s.columnValid.clear();
            }),
            "");
}

TEST(LidarSweep, Description_TellsSizesAndLayers) {
  std::ostringstream text;
  test::sampleSweep()->getDescriptionAsText(text);
  EXPECT_THAT(text.str(), HasSubstr("2 beams x 3 columns (2 received), 2 echo(es)"));
  EXPECT_THAT(text.str(), HasSubstr("5 of 6"));
  EXPECT_THAT(text.str(), HasSubstr("range, reflectivity, signal, near infrared"));
}

TEST(LidarSweep, TextExport_HasTheMeanRangeOfEachRow) {
  std::istringstream row(test::sampleSweep()->exportTxtDataRow());
  std::vector<double> values;
  for (double value = 0; row >> value;) values.push_back(value);
  ASSERT_EQ(values.size(), 6u);
  EXPECT_NEAR(values[4], (1000 + 300000) * 0.001, 1e-4);
  EXPECT_NEAR(values[5], 6 * 0.002, 1e-4);
}

TEST(LidarSweep, View_HasThePointsOfValidColumnsOnly) {
  mrpt::opengl::CSetOfObjects scene;
  test::sampleSweep()->getVisualizationInto(scene);
  const auto cloud = scene.getByClass<mrpt::opengl::CPointCloudColoured>();
  ASSERT_NE(cloud, nullptr);
  // First echo: columns 0 and 2 hold 4 returns; second echo: 1.
  EXPECT_EQ(cloud->size(), 5u);
}
