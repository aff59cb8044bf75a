#include "s2s/obs/CObservationImagingSonar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTexturedTriangles.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "s2s/core/error.h"
#include "sample_observations.h"

using namespace s2s;
using obs::CObservationImagingSonar;
using testing::HasSubstr;

namespace {

std::string faultAfter(const std::function<void(CObservationImagingSonar&)>& damage) {
  const auto ping = test::samplePing();
  damage(*ping);
  try {
    ping->checkConsistent();
  } catch (const core::InputError& e) {
    return e.fault();
  }
  return "";
}

}  // namespace

TEST(ImagingSonar, Samples_AreLittleEndianInEveryWidth) {
  CObservationImagingSonar ping;
  ping.beamCount = 2;
  ping.rangeCount = 1;
  ping.samples = {1, 2, 3, 4, 5, 6, 7, 8};
  const std::uint32_t second[] = {2, 0x0403, 0x060504, 0x08070605};
  const std::uint32_t largest[] = {0xff, 0xffff, 0xffffff, 0xffffffff};
  for (std::uint8_t bytes = 1; bytes <= 4; ++bytes) {
    ping.bytesPerSample = bytes;
    EXPECT_EQ(ping.sample(0, 1), second[bytes - 1]);
    EXPECT_EQ(ping.maxSample(), largest[bytes - 1]);
  }
}

TEST(ImagingSonar, BinRange_IsTheCentreOfTheBin) {
  const auto ping = test::samplePing();
  EXPECT_DOUBLE_EQ(ping->binRange_m(0), 0.5);
  EXPECT_DOUBLE_EQ(ping->binRange_m(3), 2.0);
  EXPECT_DOUBLE_EQ(ping->maxRange_m(), 2.25);
}

TEST(ImagingSonar, Sample_IsConsistent) {
  EXPECT_EQ(faultAfter([](auto&) {}), "");
}

TEST(ImagingSonar, FallingBearings_AreAllowed) {
  EXPECT_EQ(faultAfter([](auto& p) { p.bearings_rad = {0.5f, 0.0f, -0.5f}; }), "");
}

TEST(ImagingSonar, Contradictions_AreNamed) {
  EXPECT_THAT(faultAfter([](auto& p) { p.bytesPerSample = 5; }), HasSubstr("bytesPerSample"));
  EXPECT_THAT(faultAfter([](auto& p) { p.samples.pop_back(); }), HasSubstr("23 bytes of samples"));
  EXPECT_THAT(faultAfter([](auto& p) { p.rowGains.pop_back(); }), HasSubstr("3 row gains"));
  EXPECT_THAT(faultAfter([](auto& p) { p.bearings_rad.pop_back(); }), HasSubstr("2 bearings"));
  EXPECT_THAT(faultAfter([](auto& p) { p.bearings_rad[1] = NAN; }), HasSubstr("bearing"));
  EXPECT_THAT(faultAfter([](auto& p) { p.bearings_rad[1] = 0.75f; }), HasSubstr("monotonic"));
  EXPECT_THAT(faultAfter([](auto& p) { p.bearings_rad[2] = 0; }), HasSubstr("monotonic"));
  EXPECT_THAT(faultAfter([](auto& p) { p.rangeResolution_m = 0; }), HasSubstr("range resolution"));
  EXPECT_THAT(faultAfter([](auto& p) { p.rangeOffset_m = -1; }), HasSubstr("range offset"));
  EXPECT_THAT(faultAfter([](auto& p) { p.verticalAperture_rad = 4; }), HasSubstr("aperture"));
  EXPECT_THAT(faultAfter([](auto& p) { p.bearingModel = static_cast<obs::BearingModel>(7); }),
              HasSubstr("bearing model"));
}

TEST(ImagingSonar, InconsistentRecord_IsRefusedOnReading) {
  auto ping = test::samplePing();
  ping->beamCount = 4;  // written as it is, found on reading
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << *ping;
  memory.Seek(0);
  CObservationImagingSonar read;
  EXPECT_ANY_THROW(archive >> read);
}

TEST(ImagingSonar, Description_TellsGeometryAndUnits) {
  std::ostringstream text;
  test::samplePing()->getDescriptionAsText(text);
  EXPECT_THAT(text.str(), HasSubstr("4 ranges x 3 beams, 16 bit"));
  EXPECT_THAT(text.str(), HasSubstr("0.25 to 2.25 m, bins of 500 mm"));
  EXPECT_THAT(text.str(), HasSubstr("750 kHz"));
}

TEST(ImagingSonar, TextExport_HasTheStrongestRangeOfEachBeam) {
  auto ping = test::samplePing();  // values rise with range, so the last bin is the strongest
  std::istringstream row(ping->exportTxtDataRow());
  std::vector<double> values;
  for (double value = 0; row >> value;) values.push_back(value);
  ASSERT_EQ(values.size(), 5u + ping->beamCount);
  for (std::size_t beam = 0; beam < ping->beamCount; ++beam) EXPECT_NEAR(values[5 + beam], 2.0, 1e-4);
}

TEST(ImagingSonar, View_IsAFanOfTwoTrianglesBetweenBeams) {
  mrpt::opengl::CSetOfObjects scene;
  test::samplePing()->getVisualizationInto(scene);
  const auto fan = scene.getByClass<mrpt::opengl::CSetOfTexturedTriangles>();
  ASSERT_NE(fan, nullptr);
  EXPECT_EQ(fan->getTrianglesCount(), 4u);
  EXPECT_EQ(fan->getPoseX(), 1.5);
}

TEST(ImagingSonar, EmptyPing_HasAViewWithoutFan) {
  mrpt::opengl::CSetOfObjects scene;
  CObservationImagingSonar ping;
  EXPECT_NO_THROW(ping.getVisualizationInto(scene));
  EXPECT_EQ(scene.getByClass<mrpt::opengl::CSetOfTexturedTriangles>(), nullptr);
}
