#include "ouster2rawlog/ip_reassembly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "network_bytes.h"

using namespace s2s;
using tools::ouster::IpReassembler;

namespace {

/// A payload in which every byte tells its place.
std::string numbered(std::size_t size) {
  std::string payload(size, '\0');
  for (std::size_t i = 0; i < size; ++i) payload[i] = static_cast<char>(i * 31 + i / 256);
  return payload;
}

std::string text(const tools::ouster::UdpDatagram& datagram) {
  return {datagram.payload.begin(), datagram.payload.end()};
}

auto add(IpReassembler& reassembler, const std::string& packet, std::int64_t time = 1) {
  return reassembler.add(test::data(packet), packet.size(), time);
}

}  // namespace

TEST(IpReassembler, WholeDatagram_ComesAtOnceWithItsAddresses) {
  IpReassembler reassembler;
  const auto datagram = add(reassembler, test::ipv4(test::udp("hello", 7503)), 42);
  ASSERT_TRUE(datagram.has_value());
  EXPECT_EQ(text(*datagram), "hello");
  EXPECT_EQ(datagram->source, "10.0.0.5");
  EXPECT_EQ(datagram->sourcePort, 40000);
  EXPECT_EQ(datagram->destinationPort, 7503);
  EXPECT_EQ(datagram->captureTime_ns, 42);
}

TEST(IpReassembler, EthernetPadding_IsNoPayload) {
  IpReassembler reassembler;
  EXPECT_EQ(text(*add(reassembler, test::ipv4(test::udp("hi")) + std::string(18, '\0'))), "hi");
}

TEST(IpReassembler, FragmentsInEveryOrder_MakeTheSameDatagram) {
  const std::string payload = numbered(4000);
  auto packets = test::fragments(test::udp(payload), 1480);
  ASSERT_EQ(packets.size(), 3u);
  std::vector<std::size_t> order = {0, 1, 2};
  do {
    IpReassembler reassembler;
    EXPECT_FALSE(add(reassembler, packets[order[0]]).has_value());
    EXPECT_FALSE(add(reassembler, packets[order[1]]).has_value());
    const auto datagram = add(reassembler, packets[order[2]]);
    ASSERT_TRUE(datagram.has_value());
    EXPECT_EQ(text(*datagram), payload);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(IpReassembler, RepeatedFragment_DoesNoHarm) {
  const std::string payload = numbered(3000);
  const auto packets = test::fragments(test::udp(payload), 1480);
  IpReassembler reassembler;
  add(reassembler, packets[0]);
  add(reassembler, packets[0]);
  add(reassembler, packets[1]);
  EXPECT_EQ(text(*add(reassembler, packets[2])), payload);
}

TEST(IpReassembler, TwoDatagramsInterleaved_AreKeptApart) {
  const std::string a = numbered(2000), b = std::string(2000, 'b');
  const auto first = test::fragments(test::udp(a), 1480, 1), second = test::fragments(test::udp(b), 1480, 2);
  IpReassembler reassembler;
  add(reassembler, first[0]);
  add(reassembler, second[0]);
  EXPECT_EQ(text(*add(reassembler, first[1])), a);
  EXPECT_EQ(text(*add(reassembler, second[1])), b);
}

TEST(IpReassembler, LostFragment_IsCountedAtTheEnd) {
  const auto packets = test::fragments(test::udp(numbered(4000)), 1480);
  IpReassembler reassembler;
  add(reassembler, packets[0]);
  EXPECT_FALSE(add(reassembler, packets[2]).has_value());
  EXPECT_EQ(reassembler.statistics().incompleteDatagrams, 0u);
  reassembler.finish();
  EXPECT_EQ(reassembler.statistics().incompleteDatagrams, 1u);
}

TEST(IpReassembler, ManyOpenDatagrams_AreBoundedByDroppingTheOldest) {
  IpReassembler reassembler;
  const std::string payload = numbered(2000);
  for (std::uint16_t id = 0; id <= IpReassembler::kMaxOpen; ++id)
    add(reassembler, test::fragments(test::udp(payload), 1480, id)[0]);
  EXPECT_EQ(reassembler.statistics().incompleteDatagrams, 1u);
  EXPECT_FALSE(add(reassembler, test::fragments(test::udp(payload), 1480, 0)[1]).has_value());  // dropped
  EXPECT_EQ(text(*add(reassembler, test::fragments(test::udp(payload), 1480, 5)[1])), payload);
}

TEST(IpReassembler, OtherProtocolsAndDamage_AreCounted) {
  IpReassembler reassembler;
  const std::string good = test::ipv4(test::udp("hello"));
  EXPECT_FALSE(add(reassembler, test::ipv4("tcp segment", 1, 0, false, 6)).has_value());
  EXPECT_EQ(reassembler.statistics().notUdp, 1u);
  EXPECT_FALSE(add(reassembler, good.substr(0, 15)).has_value());
  EXPECT_FALSE(add(reassembler, good.substr(0, good.size() - 1)).has_value());
  EXPECT_FALSE(add(reassembler, test::ipv4("short")).has_value());
  EXPECT_FALSE(add(reassembler, "").has_value());
  EXPECT_EQ(reassembler.statistics().malformed, 4u);
}

TEST(IpReassembler, EveryTruncationOfAPacket_IsSurvived) {
  const std::string good = test::ipv4(test::udp("hello"));
  for (std::size_t size = 0; size < good.size(); ++size) {
    IpReassembler reassembler;
    EXPECT_FALSE(add(reassembler, good.substr(0, size)).has_value()) << size;
  }
}

TEST(IpReassembler, Ipv6_IsReadWithAndWithoutFragments) {
  const auto ipv6 = [](const std::string& payload, char next) {
    return std::string("\x60\0\0\0", 4) + test::bigEndian16(payload.size()) + next + "\x40" + std::string(15, '\0') +
           "\x01" + std::string(15, '\0') + "\x02" + payload;
  };
  IpReassembler reassembler;
  const auto whole = add(reassembler, ipv6(test::udp("six"), 17));
  ASSERT_TRUE(whole.has_value());
  EXPECT_EQ(text(*whole), "six");
  EXPECT_EQ(whole->source, "::1");

  const std::string payload = numbered(2000), datagram = test::udp(payload);
  const auto part = [&](std::size_t at, bool more) {
    const std::string header = std::string("\x11\0", 2) + test::bigEndian16(at + (more ? 1 : 0)) + "IDID";
    return ipv6(header + datagram.substr(at, 1400), 44);
  };
  EXPECT_FALSE(add(reassembler, part(1400, false)).has_value());
  EXPECT_EQ(text(*add(reassembler, part(0, true))), payload);
}
