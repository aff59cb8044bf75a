#include "ouster2rawlog/udp_capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "network_bytes.h"
#include "s2s/core/error.h"
#include "temp_folder.h"

using namespace s2s;
using tools::ouster::UdpCapture;

namespace {

std::vector<std::string> payloadsIn(UdpCapture& capture) {
  std::vector<std::string> payloads;
  while (const auto datagram = capture.next())
    payloads.emplace_back(datagram->payload.begin(), datagram->payload.end());
  return payloads;
}

std::vector<std::string> payloadsOf(const std::string& file) {
  test::TempFolder folder;
  test::writeBytes(folder.file("a.pcap"), file);
  UdpCapture capture(folder.file("a.pcap"));
  return payloadsIn(capture);
}

}  // namespace

TEST(UdpCapture, EthernetFrames_GiveTheirDatagramsAndTimes) {
  test::TempFolder folder;
  const auto frame = [](const std::string& payload) { return test::ethernet(test::ipv4(test::udp(payload))); };
  test::writeBytes(folder.file("a.pcap"), test::pcap({frame("a"), frame("b")}));
  UdpCapture capture(folder.file("a.pcap"));
  EXPECT_EQ(capture.next()->captureTime_ns, 1'700'000'000'000'000'000);
  EXPECT_EQ(capture.next()->captureTime_ns, 1'700'000'000'001'000'000);
  EXPECT_FALSE(capture.next().has_value());
  EXPECT_EQ(capture.fault(), "");
  EXPECT_DOUBLE_EQ(capture.shareRead(), 1.0);
}

TEST(UdpCapture, OtherLinkTypes_AreUnderstood) {
  const std::string packet = test::ipv4(test::udp("x"));
  const std::vector<std::string> expected = {"x"};
  EXPECT_EQ(payloadsOf(test::pcap({std::string(12, '\2') + std::string("\x81\0\0\x05\x08\0", 6) + packet})), expected);
  EXPECT_EQ(payloadsOf(test::pcap({std::string(16, '\0') + packet}, 113)), expected);  // Linux cooked
  EXPECT_EQ(payloadsOf(test::pcap({std::string(20, '\0') + packet}, 276)), expected);  // Linux cooked 2
  EXPECT_EQ(payloadsOf(test::pcap({std::string(4, '\2') + packet}, 0)), expected);     // BSD loopback
  EXPECT_EQ(payloadsOf(test::pcap({packet}, 101)), expected);                          // raw IP
}

TEST(UdpCapture, ArpAndTinyFrames_ArePassedOver) {
  EXPECT_TRUE(payloadsOf(test::pcap({std::string(12, '\2') + std::string("\x08\x06", 2) + std::string(28, 'a'), "abc"}))
                  .empty());
}

TEST(UdpCapture, TruncatedFile_GivesWhatIsWholeAndTheFault) {
  test::TempFolder folder;
  const std::string frame = test::ethernet(test::ipv4(test::udp("payload")));
  const std::string file = test::pcap({frame, frame});
  test::writeBytes(folder.file("a.pcap"), file.substr(0, file.size() - 3));
  UdpCapture capture(folder.file("a.pcap"));
  EXPECT_EQ(payloadsIn(capture).size(), 1u);
  EXPECT_THAT(capture.fault(), testing::HasSubstr("truncated"));
}

TEST(UdpCapture, PacketsCutBySnapshotLength_AreCounted) {
  test::TempFolder folder;
  std::string file = test::pcap({test::ethernet(test::ipv4(test::udp("payload")))});
  test::put<std::uint32_t>(file, 24 + 12, 9000);  // original length, beyond what was kept
  test::writeBytes(folder.file("a.pcap"), file);
  UdpCapture capture(folder.file("a.pcap"));
  EXPECT_TRUE(payloadsIn(capture).empty());
  EXPECT_EQ(capture.cutPackets(), 1u);
}

TEST(UdpCapture, NoCaptureOrUnknownLink_Throws) {
  test::TempFolder folder;
  EXPECT_THROW(UdpCapture("/nowhere/a.pcap"), core::InputError);
  test::writeBytes(folder.file("a.pcap"), "this is a letter");
  EXPECT_THROW(UdpCapture(folder.file("a.pcap")), core::InputError);
  test::writeBytes(folder.file("b.pcap"), test::pcap({}, 105));  // 802.11
  EXPECT_THROW(UdpCapture(folder.file("b.pcap")), core::InputError);
}
