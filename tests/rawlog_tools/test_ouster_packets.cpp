#include <gtest/gtest.h>

#include <cmath>

#include "byte_writer.h"
#include "ouster2rawlog/imu_packet.h"
#include "ouster2rawlog/lidar_packet.h"
#include "ouster_bytes.h"
#include "s2s/core/error.h"

using namespace s2s;
using namespace s2s::tools::ouster;

namespace {

/// Values that differ in every field and fill the widest bit.
test::OusterPixel extremePixel(const std::string& profile) {
  const bool narrow = profile.find("RNG15") != std::string::npos;
  const std::uint32_t largest = narrow ? 0x7fff : profile == "LEGACY" ? 0xfffff : 0x7ffff;
  test::OusterPixel pixel;
  pixel.range = largest - 2;
  pixel.range2 = largest - 5;
  pixel.reflectivity = 0xfe;
  pixel.reflectivity2 = 0x81;
  pixel.signal = 0xfffd;
  pixel.signal2 = 0x8001;
  pixel.nearInfrared = narrow ? 0xfb : 0xf00f;
  pixel.flags = narrow ? 1 : profile == "LEGACY" ? 0xd : 0x15;
  pixel.flags2 = narrow ? 0 : 0x1e;
  return pixel;
}

class LidarPacket : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(LidarPacket, EveryField_IsReadFromItsPlace) {
  const std::string profile = GetParam();
  const bool narrow = profile.find("RNG15") != std::string::npos;
  const auto expected = extremePixel(profile);
  test::OusterPacketMaker maker;
  maker.metadata = test::ousterMetadata(profile);
  maker.pixel = [&](std::uint32_t row, std::uint32_t column) {
    return row == 2 && column == 13 ? expected : test::OusterPixel();
  };
  maker.valid = [](std::uint32_t column) { return column != 11; };
  const std::string packet = maker.packet(1795, 8);
  const LidarPacketFormat format(maker.metadata);
  ASSERT_EQ(packet.size(), format.packetBytes());
  EXPECT_EQ(format.header(test::data(packet)).type, 1u);
  EXPECT_EQ(format.header(test::data(packet)).frameId, 1795u);
  if (!format.isLegacy()) {
    EXPECT_EQ(format.header(test::data(packet)).initializationId, 77u);
    EXPECT_EQ(format.header(test::data(packet)).serialNumber, 122u);
  }
  for (std::uint32_t c = 0; c < 8; ++c) {
    const auto column = format.column(test::data(packet), c);
    EXPECT_EQ(column.measurementId, 8 + c);
    EXPECT_EQ(column.time_ns, 5'000'000'000u + 1000u * (8 + c));
    EXPECT_EQ(column.valid, c != 3);
    for (std::uint32_t row = 0; row < 4; ++row) {
      const auto* pixel = format.pixel(test::data(packet), c, row);
      const auto& fields = format.profile();
      const auto want = row == 2 && c == 5 ? expected : test::OusterPixel();
      const auto& first = fields.echoes[0];
      EXPECT_EQ(first.range.read(pixel), want.range * (narrow ? 8 : 1));
      EXPECT_EQ(first.reflectivity.read(pixel), want.reflectivity);
      EXPECT_EQ(first.flags.read(pixel), want.flags);
      if (first.signal.exists()) {
        EXPECT_EQ(first.signal.read(pixel), want.signal);
      }
      EXPECT_EQ(first.signal.exists(), !narrow);
      EXPECT_EQ(fields.nearInfrared.read(pixel), want.nearInfrared * (narrow ? 16 : 1));
      if (fields.echoes.size() < 2) continue;
      const auto& second = fields.echoes[1];
      EXPECT_EQ(second.range.read(pixel), want.range2 * (narrow ? 8 : 1));
      EXPECT_EQ(second.reflectivity.read(pixel), want.reflectivity2);
      EXPECT_EQ(second.flags.read(pixel), want.flags2);
      if (second.signal.exists()) {
        EXPECT_EQ(second.signal.read(pixel), want.signal2);
      }
    }
  }
  EXPECT_EQ(format.profile().echoes.size(), profile.find("DUAL") != std::string::npos ? 2u : 1u);
}

INSTANTIATE_TEST_SUITE_P(Profiles, LidarPacket,
                         testing::Values("LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL",
                                         "RNG15_RFL8_NIR8", "RNG15_RFL8_NIR8_DUAL", "FUSA_RNG15_RFL8_NIR8_DUAL"));

TEST(LidarPacketFormat, PacketSizes_AreThoseOfTheManual) {
  // UDP payloads of 128-beam sensors with 16 columns a packet, by the sensor manual.
  auto metadata = test::ousterMetadata("LEGACY");
  metadata.rows = 128;
  metadata.columnsPerPacket = 16;
  const auto bytes = [&](const char* profile) {
    metadata.lidarProfile = profile;
    return LidarPacketFormat(metadata).packetBytes();
  };
  EXPECT_EQ(bytes("LEGACY"), 24896u);
  EXPECT_EQ(bytes("RNG19_RFL8_SIG16_NIR16"), 24832u);
  EXPECT_EQ(bytes("RNG19_RFL8_SIG16_NIR16_DUAL"), 33024u);
  EXPECT_EQ(bytes("RNG15_RFL8_NIR8"), 8448u);
}

TEST(LidarPacketFormat, UnknownProfile_IsRefusedNamingTheKnownOnes) {
  try {
    LidarPacketFormat format(test::ousterMetadata("RNG99"));
    FAIL() << "accepted";
  } catch (const core::InputError& e) {
    EXPECT_NE(e.fault().find("RNG99"), std::string::npos);
    EXPECT_NE(e.remedy().find("RNG19_RFL8_SIG16_NIR16_DUAL"), std::string::npos);
  }
}

TEST(ImuPacket, LegacyPacket_IsInSiUnitsAtTheGyroscopesTime) {
  test::ByteWriter packet;
  packet.add(std::uint64_t{1000}).add(std::uint64_t{2000}).add(std::uint64_t{3000});
  for (const float value : {0.5f, -0.25f, 1.0f, 90.0f, -180.0f, 0.0f}) packet.add(value);
  ASSERT_TRUE(isImuPacketSize(packet.bytes().size()));
  const auto readings = parseImuPacket(test::data(packet.bytes()), packet.bytes().size());
  ASSERT_EQ(readings.size(), 1u);
  EXPECT_EQ(readings[0].time_ns, 3000u);
  EXPECT_TRUE(readings[0].acceleration_mps2.isApprox(9.80665 * Eigen::Vector3d(0.5, -0.25, 1)));
  EXPECT_TRUE(readings[0].turnRate_radps.isApprox(Eigen::Vector3d(M_PI / 2, -M_PI, 0)));
}

TEST(ImuPacket, NewerPacket_GivesItsValidReadings) {
  test::ByteWriter packet;
  packet.zeros(32 + 100);
  for (std::uint16_t i = 0; i < 4; ++i) {
    packet.add(std::uint64_t{100} * i).add(i).add(static_cast<std::uint16_t>(i != 2));
    packet.add(0.0f).add(0.0f).add(1.0f).add(0.0f).add(0.0f).add(static_cast<float>(i));
  }
  packet.zeros(32);
  ASSERT_TRUE(isImuPacketSize(packet.bytes().size()));
  const auto readings = parseImuPacket(test::data(packet.bytes()), packet.bytes().size());
  ASSERT_EQ(readings.size(), 3u);
  EXPECT_EQ(readings[2].time_ns, 300u);
  EXPECT_NEAR(readings[2].turnRate_radps.z(), 3 * M_PI / 180, 1e-12);
}

TEST(ImuPacket, OtherSizes_AreNoImuPackets) {
  for (const std::size_t bytes : {0, 47, 49, 164, 165, 199, 201}) EXPECT_FALSE(isImuPacketSize(bytes)) << bytes;
  EXPECT_TRUE(isImuPacketSize(164 + 36));
}
