// A real capture against the MD5 sums that Ouster publishes with it. As Ouster's SDK computes them: the fields of all
// packets one after the other, rows x columns of a packet in row-major order, in the field's own width; and the images
// of the sweep, rows x columns as sent ("staggered").

#include <gtest/gtest.h>
#include <mrpt/system/md5.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "byte_writer.h"
#include "ouster2rawlog/lidar_packet.h"
#include "ouster2rawlog/sweep_builder.h"
#include "ouster2rawlog/udp_capture.h"

using namespace s2s;
using namespace s2s::tools::ouster;

namespace {

class OusterDigest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string stem = std::string(S2S_DATA_DIR) + "/ouster/OS-1-32-G_v2.1.1_1024x10";
    std::ifstream digestFile(stem + "_digest.json");
    if (!digestFile) GTEST_SKIP() << "the capture " << stem << " is not there";
    digest_ = nlohmann::json::parse(digestFile);
    metadata_ = loadMetadata(stem + ".json");
    UdpCapture capture(stem + ".pcap");
    while (auto datagram = capture.next()) packets_.push_back(std::move(datagram->payload));
  }

  nlohmann::json digest_;
  Metadata metadata_;
  std::vector<std::vector<std::uint8_t>> packets_;
};

std::string md5(const std::string& bytes) { return mrpt::system::md5(bytes); }

template <class Stored, class Value>
std::string md5As(const std::vector<Value>& values) {
  test::ByteWriter out;
  for (const Value value : values) out.add(static_cast<Stored>(value));
  return md5(out.bytes());
}

}  // namespace

TEST_F(OusterDigest, PacketFields_EqualThePublishedSums) {
  const LidarPacketFormat format(metadata_);
  const auto& fields = format.profile().echoes.at(0);
  std::map<std::string, test::ByteWriter> bytes;
  for (const auto& packet : packets_) {
    ASSERT_EQ(packet.size(), format.packetBytes());
    for (std::uint32_t c = 0; c < format.columnsPerPacket(); ++c) {
      const auto column = format.column(packet.data(), c);
      bytes["TIMESTAMP"].add(column.time_ns);
      bytes["MEASUREMENT_ID"].add(static_cast<std::uint16_t>(column.measurementId));
      bytes["STATUS"].add(column.valid ? 0xffffffffu : 0u);
      bytes["FRAME_ID"].add(static_cast<std::uint16_t>(format.header(packet.data()).frameId));
    }
    for (std::uint32_t row = 0; row < metadata_.rows; ++row)
      for (std::uint32_t c = 0; c < format.columnsPerPacket(); ++c) {
        const auto* pixel = format.pixel(packet.data(), c, row);
        bytes["RANGE"].add(fields.range.read(pixel));
        bytes["FLAGS"].add(static_cast<std::uint8_t>(fields.flags.read(pixel)));
        bytes["REFLECTIVITY"].add(static_cast<std::uint8_t>(fields.reflectivity.read(pixel)));
        bytes["SIGNAL"].add(static_cast<std::uint16_t>(fields.signal.read(pixel)));
        bytes["NEAR_IR"].add(static_cast<std::uint16_t>(format.profile().nearInfrared.read(pixel)));
      }
  }
  for (const auto& [name, writer] : bytes)
    EXPECT_EQ(md5(writer.bytes()), digest_.at("packet_hash").at(name).get<std::string>()) << name;
}

TEST_F(OusterDigest, SweepImages_EqualThePublishedSums) {
  const LidarPacketFormat format(metadata_);
  SweepBuilder builder(metadata_, format, 0, true);
  for (const auto& packet : packets_) ASSERT_EQ(builder.add(packet.data()), nullptr);
  const auto sweep = builder.finish();
  ASSERT_NE(sweep, nullptr);
  const auto& published = digest_.at("scans").at(0);
  const auto sum = [&](const char* name) { return published.at(name).get<std::string>(); };
  EXPECT_EQ(std::to_string(sweep->frameId), sum("FRAME_ID"));
  EXPECT_EQ(md5As<std::uint32_t>(sweep->echoes[0].range), sum("RANGE"));
  EXPECT_EQ(md5As<std::uint16_t>(sweep->echoes[0].signal), sum("SIGNAL"));
  EXPECT_EQ(md5As<std::uint8_t>(sweep->echoes[0].reflectivity), sum("REFLECTIVITY"));
  EXPECT_EQ(md5As<std::uint16_t>(sweep->nearInfrared), sum("NEAR_IR"));
  std::vector<std::int64_t> times;
  for (const auto offset : sweep->columnTime_ns) times.push_back(core::fromMrptTime(sweep->timestamp) + offset);
  EXPECT_EQ(md5As<std::uint64_t>(times), sum("TIMESTAMP"));
}
