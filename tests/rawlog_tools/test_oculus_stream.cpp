#include <gtest/gtest.h>

#include <sstream>

#include "oculus2rawlog/message_stream.h"
#include "oculus_bytes.h"

using namespace s2s;
using tools::oculus::MessageStream;

namespace {

struct Split {
  std::vector<std::string> messages;
  std::vector<std::uint64_t> places;
  std::uint64_t garbage = 0, cut = 0, firstGarbage = 0;
};

Split split(const std::string& bytes) {
  std::istringstream in(bytes);
  MessageStream stream(in);
  Split result;
  while (const auto message = stream.next()) {
    result.messages.emplace_back(message->bytes);
    result.places.push_back(message->at);
  }
  result.garbage = stream.garbageBytes();
  result.cut = stream.cutMessages();
  result.firstGarbage = stream.firstGarbageAt();
  return result;
}

std::string ping(std::uint32_t id) {
  test::OculusPing p;
  p.pingId = id;
  return test::oculusMessage(p);
}

}  // namespace

TEST(OculusStream, MessagesBackToBack_AreSplit) {
  const auto result = split(ping(1) + test::oculusHeader(0xff, 0, 0) + ping(2));
  ASSERT_EQ(result.messages.size(), 3u);
  EXPECT_EQ(result.messages[0], ping(1));
  EXPECT_EQ(result.messages[2], ping(2));
  EXPECT_EQ(result.places[2], ping(1).size() + 16);
  EXPECT_EQ(result.garbage, 0u);
}

TEST(OculusStream, GarbageBetweenMessages_IsPassedOverAndCounted) {
  const auto result = split("abcSO" + ping(1) + std::string(1000, 'S') + ping(2) + "xyz");
  ASSERT_EQ(result.messages.size(), 2u);
  EXPECT_EQ(result.messages[1], ping(2));
  EXPECT_EQ(result.garbage, 5u + 1000u + 3u);
  EXPECT_EQ(result.firstGarbage, 0u);
}

TEST(OculusStream, MessageThatLostBytes_IsGivenUpAndTheNextFound) {
  for (const std::size_t lost : {1u, 10u, 60u}) {
    std::string damaged = ping(1);
    damaged.erase(130, lost);
    const auto result = split(damaged + ping(2) + ping(3));
    ASSERT_EQ(result.messages.size(), 2u) << lost;
    EXPECT_EQ(result.messages[0], ping(2));
    EXPECT_EQ(result.cut, 1u);
    EXPECT_EQ(result.garbage, damaged.size());
  }
}

TEST(OculusStream, StreamThatEndsWithinAMessage_GivesTheOthers) {
  const auto result = split(ping(1) + ping(2).substr(0, 100));
  EXPECT_EQ(result.messages.size(), 1u);
  EXPECT_EQ(result.cut, 1u);
  EXPECT_EQ(result.garbage, 100u);
}

TEST(OculusStream, HeaderWithAnAbsurdSize_IsGarbage) {
  const auto result = split(test::oculusHeader(0x23, 0, 0xfffffff0) + ping(1));
  EXPECT_EQ(result.messages.size(), 1u);
  EXPECT_EQ(result.garbage, 16u);
}

TEST(OculusStream, LongStream_IsReadInPiecesWithRightPlaces) {
  // Messages of 1 MB, so that they straddle the reader's buffer again and again.
  test::OculusPing big;
  big.ranges = 4096;
  big.beams = 4;
  big.bytesPerSample = 4;
  std::string bytes;
  for (std::uint32_t id = 0; id < 60; ++id) {
    big.pingId = id;
    bytes += test::oculusMessage(big);
  }
  const auto result = split(bytes);
  ASSERT_EQ(result.messages.size(), 60u);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_EQ(result.places[i], i * bytes.size() / 60);
  EXPECT_EQ(result.garbage, 0u);
}

TEST(OculusStream, EmptyStream_HasNoMessage) { EXPECT_TRUE(split("").messages.empty()); }
