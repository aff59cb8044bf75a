#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <tuple>

#include "oculus2rawlog/device_clock.h"
#include "oculus2rawlog/oculus_converter.h"
#include "oculus2rawlog/ping_message.h"
#include "oculus_bytes.h"

using namespace s2s;
using namespace s2s::tools::oculus;
using testing::HasSubstr;

namespace {

using Kind = std::tuple<int, int, bool>;  // layout, bytes a sample, gain

class OculusPingKind : public testing::TestWithParam<Kind> {};

std::string faultAfter(const std::function<void(std::string&)>& damage) {
  std::string message = test::oculusMessage({});
  damage(message);
  return parsePing(message).fault;
}

Ping pingAt(std::uint32_t id, std::uint32_t time_ns) {
  Ping ping;
  ping.pingId = id;
  ping.startTime_ns = time_ns;
  return ping;
}

}  // namespace

TEST_P(OculusPingKind, EveryField_IsRead) {
  test::OculusPing sent;
  std::tie(sent.layout, sent.bytesPerSample, sent.gain) = GetParam();
  sent.startTime = sent.layout == 2 ? 123.456 : 4'000'000'000.0;
  const auto result = parsePing(test::oculusMessage(sent));
  ASSERT_TRUE(result.ping.has_value()) << result.fault;
  const Ping& ping = *result.ping;
  EXPECT_EQ(ping.pingId, 7u);
  EXPECT_EQ(ping.frequency_hz, 750e3);
  EXPECT_EQ(ping.soundSpeed_mps, 1475.25);
  EXPECT_EQ(ping.gain_percent, 55);
  EXPECT_EQ(ping.rangeResolution_m, 0.0125);
  EXPECT_EQ(ping.rangeCount, 5);
  EXPECT_EQ(ping.beamCount, 4);
  EXPECT_EQ(ping.bytesPerSample, sent.bytesPerSample);
  EXPECT_EQ(ping.bearings_cdeg, sent.bearings);
  if (sent.layout == 2)
    EXPECT_EQ(ping.startTime_s, 123.456);
  else
    EXPECT_EQ(ping.startTime_ns, 4'000'000'000u);

  ASSERT_EQ(ping.rowGains.size(), sent.gain ? 5u : 0u);
  for (std::uint32_t range = 0; range < ping.rowGains.size(); ++range)
    EXPECT_EQ(ping.rowGains[range], test::oculusGain(range));
  const auto observation = toObservation(ping, {});
  EXPECT_NO_THROW(observation->checkConsistent());
  for (std::uint32_t range = 0; range < 5; ++range)
    for (std::uint32_t beam = 0; beam < 4; ++beam)
      EXPECT_EQ(observation->sample(range, beam), test::oculusSample(sent, range, beam));
}

INSTANTIATE_TEST_SUITE_P(AllKinds, OculusPingKind,
                         testing::Combine(testing::Values(1, 2), testing::Values(1, 2, 3, 4), testing::Bool()));

TEST(OculusPing, BearingsToStarboard_BecomeNegativeAngles) {
  const auto observation = toObservation(*parsePing(test::oculusMessage({})).ping, {});
  // The first beam of the device is -60 degrees, to port: +60 degrees in a frame with y to port.
  EXPECT_NEAR(observation->bearings_rad.front(), M_PI / 3, 1e-6);
  EXPECT_NEAR(observation->bearings_rad.back(), -M_PI / 3, 1e-6);
  EXPECT_NEAR(observation->bearings_rad[1], 10 * M_PI / 180, 1e-6);
}

TEST(OculusPing, DamagedFields_AreNamed) {
  EXPECT_THAT(faultAfter([](auto& m) { m.pop_back(); }), HasSubstr("ends early"));
  EXPECT_THAT(faultAfter([](auto& m) { m[97] = 9; }), HasSubstr("sample format 9"));
  EXPECT_THAT(faultAfter([](auto& m) { m[97] = 1; }), HasSubstr("neither with nor without gains"));
  EXPECT_THAT(faultAfter([](auto& m) { test::put<double>(m, 98, -1); }), HasSubstr("range resolution"));
  EXPECT_THAT(faultAfter([](auto& m) { test::put<double>(m, 98, NAN); }), HasSubstr("range resolution"));
  EXPECT_THAT(faultAfter([](auto& m) { test::put<std::uint16_t>(m, 106, 0); }), HasSubstr("no size"));
  EXPECT_THAT(faultAfter([](auto& m) { test::put<std::uint16_t>(m, 108, 60000); }), HasSubstr("contradict"));
  EXPECT_THAT(faultAfter([](auto& m) { test::put<std::uint32_t>(m, 110, 0xffffffff); }), HasSubstr("contradict"));
  EXPECT_THAT(faultAfter([](auto& m) { test::put<std::uint32_t>(m, 114, 0xffffffff); }), HasSubstr("contradict"));
  EXPECT_THAT(faultAfter([](auto& m) { test::put<std::uint32_t>(m, 118, 5); }), HasSubstr("contradict"));
  EXPECT_THAT(faultAfter([](auto& m) { test::put<std::int16_t>(m, 124, 3000); }), HasSubstr("not in order"));
  EXPECT_THAT(faultAfter([](auto& m) { m[6] = 0x15; }), HasSubstr("no simple ping"));
}

TEST(OculusPing, EveryTruncation_IsSurvived) {
  const std::string message = test::oculusMessage({});
  for (std::size_t size = 0; size < message.size(); ++size)
    EXPECT_FALSE(parsePing(message.substr(0, size)).ping.has_value()) << size;
}

TEST(OculusDeviceClock, CounterThatWraps_GoesOnRising) {
  DeviceClock clock;
  const std::uint32_t period = 62'500'000, first = 0xffffffffu - 100'000'000u;
  std::int64_t last = clock.time_ns(pingAt(1, first));
  for (std::uint32_t i = 1; i < 200; ++i) {  // 12.5 s: three wraps
    const std::int64_t now = clock.time_ns(pingAt(1 + i, first + i * period));
    EXPECT_EQ(now - last, period);
    last = now;
  }
}

TEST(OculusDeviceClock, PauseLongerThanAWrap_IsBridgedByPingNumbers) {
  DeviceClock clock;
  const std::uint32_t period = 100'000'000;
  const std::int64_t start = clock.time_ns(pingAt(1, 0));
  clock.time_ns(pingAt(2, period));
  // 300 pings = 30 s later the counter has wrapped seven times (multiplication modulo 2^32 is what the device does).
  EXPECT_EQ(clock.time_ns(pingAt(302, 301u * period)) - start, std::int64_t{301} * period);
}

TEST(OculusDeviceClock, AbsurdPingNumber_DoesNotMoveTheClock) {
  DeviceClock clock;
  clock.time_ns(pingAt(1, 0));
  clock.time_ns(pingAt(2, 100'000'000));
  EXPECT_EQ(clock.time_ns(pingAt(4'000'000'000u, 200'000'000)), 200'000'000);
}

TEST(OculusDeviceClock, PingNumbersThatStartAgain_AreTakenAsOnePeriodOn) {
  DeviceClock clock;
  clock.time_ns(pingAt(1000, 0));
  clock.time_ns(pingAt(1001, 50'000'000));
  EXPECT_EQ(clock.time_ns(pingAt(0, 100'000'000)), 100'000'000);
}

TEST(OculusDeviceClock, SecondsOfTheSecondLayout_AreTakenAsTheyAre) {
  DeviceClock clock;
  Ping ping;
  ping.startTime_s = 5000.25;
  EXPECT_EQ(clock.time_ns(ping), 5'000'250'000'000);
}
