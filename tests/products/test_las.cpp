#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "s2s/core/error.h"
#include "s2s/products/gps_time.h"
#include "s2s/products/las_writer.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

using test::readBytes;
using test::TempFolder;
using test::writeBytes;

/// Reads LAS 1.4 by the byte tables of ASPRS LAS 1.4-R15, with no code of the writer.
class LasBytes {
 public:
  explicit LasBytes(std::string bytes) : bytes_(std::move(bytes)) {}

  template <class Number>
  Number at(std::size_t place) const {
    Number value;
    if (place + sizeof value > bytes_.size()) throw std::out_of_range("LAS file too short");
    std::memcpy(&value, bytes_.data() + place, sizeof value);
    return value;
  }
  /// Up to the first zero byte.
  std::string text(std::size_t place, std::size_t length) const {
    const std::string field = bytes_.substr(place, length);
    return field.substr(0, field.find('\0'));
  }
  std::size_t size() const { return bytes_.size(); }

  std::size_t pointOffset() const { return at<std::uint32_t>(96); }
  std::size_t recordLength() const { return at<std::uint16_t>(105); }
  std::uint64_t pointCount() const { return at<std::uint64_t>(247); }
  std::size_t record(std::size_t i) const { return pointOffset() + i * recordLength(); }
  double coordinate(std::size_t i, std::size_t axis) const {
    return at<std::int32_t>(record(i) + 4 * axis) * at<double>(131 + 8 * axis) + at<double>(155 + 8 * axis);
  }

 private:
  std::string bytes_;
};

// 2024-12-05 12:00:00.25 UTC.
constexpr core::TimeNs kTime = 1'733'400'000'250'000'000;

std::vector<map::MapPoint> samplePoints() {
  std::vector<map::MapPoint> points(3);
  points[0].p_map = {123456.7894, -2.0006, 12.3456};
  points[0].intensity = 100;
  points[0].sigma_m = 0.031F;
  points[0].time = kTime;
  points[1].p_map = {123400, 10, -4.5};
  points[1].intensity = 255;
  points[1].layer = map::Layer::Stereo;
  points[1].time = kTime + 1'000'000;
  points[2].p_map = {123500, 0, 0};
  points[2].intensity = -3;  // nonsense, but no reason to stop
  points[2].layer = map::Layer::LineVertical;
  points[2].time = kTime;
  return points;
}

LasBytes writeSample(const TempFolder& folder) {
  LasFrame frame;
  frame.offset_m = {123450, 0, 0};
  frame.intensityFactor = {257, 257, 257, 257};
  frame.surveyTime = kTime;
  LasWriter writer(folder.file("a.las"), frame);
  for (const auto& point : samplePoints()) EXPECT_TRUE(writer.add(point));
  writer.finish();
  return LasBytes(readBytes(folder.file("a.las")));
}

TEST(LasWriter, Header_FollowsTheSpecification) {
  const TempFolder folder;
  const LasBytes las = writeSample(folder);
  EXPECT_EQ(las.text(0, 4), "LASF");
  EXPECT_EQ(las.at<std::uint16_t>(6), 0b10001);  // adjusted standard GPS time and WKT, as format 6 demands
  EXPECT_EQ(las.at<std::uint8_t>(24), 1);
  EXPECT_EQ(las.at<std::uint8_t>(25), 4);
  EXPECT_EQ(las.text(58, 13), "Seabed-to-Sky");
  EXPECT_EQ(las.at<std::uint16_t>(90), 340);  // 5 December of a leap year
  EXPECT_EQ(las.at<std::uint16_t>(92), 2024);
  EXPECT_EQ(las.at<std::uint16_t>(94), 375);
  EXPECT_EQ(las.at<std::uint8_t>(104), 6);
  EXPECT_EQ(las.recordLength(), 34);
  EXPECT_EQ(las.at<std::uint32_t>(107), 0U);  // legacy counts are zero for format 6
  EXPECT_EQ(las.at<std::uint64_t>(227), 0U);  // no waveforms
  EXPECT_EQ(las.at<std::uint32_t>(243), 0U);  // no extended records
  EXPECT_EQ(las.pointCount(), 3U);
  EXPECT_EQ(las.at<std::uint64_t>(255), 3U);
  EXPECT_EQ(las.size(), las.pointOffset() + 3 * las.recordLength());
  // Bounds hold the coordinates as stored: maximum x, minimum x, maximum y, …
  EXPECT_NEAR(las.at<double>(179), 123500, 1e-9);
  EXPECT_NEAR(las.at<double>(187), 123400, 1e-9);
  EXPECT_NEAR(las.at<double>(195), 10, 1e-9);
  EXPECT_NEAR(las.at<double>(203), -2.001, 1e-9);
  EXPECT_NEAR(las.at<double>(211), 12.346, 1e-9);
  EXPECT_NEAR(las.at<double>(219), -4.5, 1e-9);
}

TEST(LasWriter, VariableLengthRecords_HoldReferenceAndExtraBytes) {
  const TempFolder folder;
  const LasBytes las = writeSample(folder);
  std::map<std::string, std::size_t> payload;  // "user id/record id" to its place
  std::size_t place = 375;
  for (std::uint32_t i = 0; i < las.at<std::uint32_t>(100); ++i) {
    payload[las.text(place + 2, 16) + "/" + std::to_string(las.at<std::uint16_t>(place + 18))] = place + 54;
    place += 54 + las.at<std::uint16_t>(place + 20);
  }
  EXPECT_EQ(place, las.pointOffset());
  ASSERT_EQ(payload.count("LASF_Projection/2112"), 1U);
  EXPECT_EQ(las.text(payload["LASF_Projection/2112"], 9), "LOCAL_CS[");
  ASSERT_EQ(payload.count("LASF_Spec/4"), 1U);
  const std::size_t extra = payload["LASF_Spec/4"];
  EXPECT_EQ(las.at<std::uint8_t>(extra + 2), 9);  // float
  EXPECT_EQ(las.at<std::uint8_t>(extra + 3), 0);  // no scale, offset or limits given
  EXPECT_EQ(las.text(extra + 4, 32), "sigma");
  EXPECT_EQ(las.text(extra + 160, 32), "std. dev. of position [m]");
}

TEST(LasWriter, Points_HoldWhatWasGiven) {
  const TempFolder folder;
  const LasBytes las = writeSample(folder);
  const auto points = samplePoints();
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      // Whole millimetres: at most half of one away.
      EXPECT_NEAR(las.coordinate(i, axis), points[i].p_map[static_cast<int>(axis)], 0.0005 + 1e-9);
  EXPECT_EQ(las.at<std::uint16_t>(las.record(0) + 12), 25700);
  EXPECT_EQ(las.at<std::uint16_t>(las.record(1) + 12), 65535);
  EXPECT_EQ(las.at<std::uint16_t>(las.record(2) + 12), 0);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(las.at<std::uint8_t>(las.record(i) + 14), 0x11);  // return 1 of 1
  EXPECT_EQ(las.at<std::uint8_t>(las.record(0) + 16), 1);                                         // unclassified
  EXPECT_EQ(las.at<std::uint8_t>(las.record(1) + 16), 40);                                        // bathymetric
  EXPECT_EQ(las.at<std::uint8_t>(las.record(2) + 16), 40);
  EXPECT_EQ(las.at<std::uint8_t>(las.record(2) + 17), 3);  // user data: the layer
  // 1733400000.25 Unix = 1417435218.25 GPS (18 leap seconds), less 1e9.
  EXPECT_NEAR(las.at<double>(las.record(0) + 22), 417'435'218.25, 1e-7);
  EXPECT_NEAR(las.at<double>(las.record(1) + 22), 417'435'218.251, 1e-7);
  EXPECT_EQ(las.at<float>(las.record(0) + 30), 0.031F);
}

TEST(LasWriter, ManyPoints_AreAllThere) {
  const TempFolder folder;
  constexpr int kCount = 100'000;  // several times the writer's buffer
  LasWriter writer(folder.file("many.las"), LasFrame{});
  map::MapPoint point;
  for (int i = 0; i < kCount; ++i) {
    point.p_map.x() = 0.001 * i;
    writer.add(point);
  }
  writer.finish();
  const LasBytes las(readBytes(folder.file("many.las")));
  ASSERT_EQ(las.size(), las.pointOffset() + kCount * las.recordLength());
  for (std::size_t i = 0; i < kCount; ++i) EXPECT_EQ(las.at<std::int32_t>(las.record(i)), static_cast<std::int32_t>(i));
}

TEST(LasWriter, PointWithoutAPlace_IsRefusedAndNotCounted) {
  const TempFolder folder;
  LasWriter writer(folder.file("a.las"), LasFrame{});
  map::MapPoint point;
  point.p_map = {2.2e6, 0, 0};
  EXPECT_FALSE(writer.add(point));
  point.p_map = {0, std::nan(""), 0};
  EXPECT_FALSE(writer.add(point));
  writer.finish();
  const LasBytes las(readBytes(folder.file("a.las")));
  EXPECT_EQ(las.pointCount(), 0U);
  EXPECT_EQ(las.at<double>(179), 0);  // no infinite bounds in an empty file
}

TEST(LasWriter, UnwritableOrUnfinished_LeavesNothing) {
  const TempFolder folder;
  { LasWriter writer(folder.file("a.las"), LasFrame{}); }
  EXPECT_EQ(folder.fileCount(), 0U);
  writeBytes(folder.file("taken"), "x");
  EXPECT_THROW(LasWriter(folder.file("taken/a.las"), LasFrame{}), core::OutputError);
}

TEST(LasIntensityFactor, SpreadsTheSensorsRangeOver16Bits) {
  EXPECT_EQ(lasIntensityFactor(0.9), 65535);
  EXPECT_EQ(lasIntensityFactor(255) * 255, 65535);
  EXPECT_EQ(lasIntensityFactor(256), 1);
}

TEST(GpsTime, LeapSeconds_ChangeOnTheirDays) {
  EXPECT_EQ(leapSeconds(core::parseTime("1980-01-06T00:00:00Z", "t")), 0);
  EXPECT_EQ(leapSeconds(core::parseTime("1999-01-01T00:00:00Z", "t")), 13);
  EXPECT_EQ(leapSeconds(core::parseTime("2016-12-31T23:59:59Z", "t")), 17);
  EXPECT_EQ(leapSeconds(core::parseTime("2017-01-01T00:00:00Z", "t")), 18);
}

TEST(GpsTime, AdjustedTime_MatchesKnownInstants) {
  // GPS second 1e9 was 2011-09-14 01:46:25 UTC (15 leap seconds).
  EXPECT_EQ(adjustedGpsTime_s(core::parseTime("2011-09-14T01:46:25Z", "t")), 0);
  EXPECT_EQ(adjustedGpsTime_s(core::parseTime("1980-01-06T00:00:00Z", "t")), -1e9);
}

}  // namespace
}  // namespace s2s::products
