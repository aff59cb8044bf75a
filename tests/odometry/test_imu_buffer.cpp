#include <gtest/gtest.h>

#include "s2s/odometry/imu_buffer.h"

namespace s2s::odometry {
namespace {

ImuSample sampleAt(double t, double rate) {
  ImuSample sample;
  sample.time = core::durationNs(t);
  sample.angularRate_radps = {rate, 0, 0};
  sample.specificForce_mps2 = {0, 0, 9.81};
  return sample;
}

ImuBuffer rampBuffer() {
  ImuBuffer buffer;
  for (int i = 0; i <= 10; ++i) buffer.add(sampleAt(0.01 * i, 0.01 * i));  // rate = t
  return buffer;
}

TEST(ImuBuffer, LinearReadings_IntegrateExactly) {
  const auto steps = rampBuffer().steps(core::durationNs(0.0123), core::durationNs(0.0777), 0.1);
  double angle = 0, duration = 0;
  for (const auto& step : steps) {
    EXPECT_TRUE(step.isMeasured);
    angle += step.duration_s * step.angularRate_radps.x();
    duration += step.duration_s;
  }
  // The midpoint rule is exact for a linear reading.
  EXPECT_NEAR(angle, 0.5 * (0.0777 * 0.0777 - 0.0123 * 0.0123), 1e-12);
  EXPECT_NEAR(duration, 0.0777 - 0.0123, 1e-9);
  EXPECT_EQ(steps.back().end, core::durationNs(0.0777));
}

TEST(ImuBuffer, SilenceLongerThanTheGap_IsBridgedWithTheLastRate) {
  ImuBuffer buffer;
  buffer.add(sampleAt(0, 1));
  buffer.add(sampleAt(0.01, 2));
  buffer.add(sampleAt(0.3, 5));
  const auto steps = buffer.steps(0, core::durationNs(0.3), 0.1);
  ASSERT_GE(steps.size(), 30U);  // 290 ms in steps of at most 10 ms, after the measured one
  EXPECT_TRUE(steps.front().isMeasured);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_FALSE(steps[i].isMeasured);
    EXPECT_LE(steps[i].duration_s, 0.010001);
    EXPECT_EQ(steps[i].angularRate_radps.x(), 2);
  }
  EXPECT_EQ(steps.back().end, core::durationNs(0.3));
}

TEST(ImuBuffer, NoSamples_GiveUnmeasuredSteps) {
  const auto steps = ImuBuffer().steps(0, core::durationNs(0.1), 0.1);
  ASSERT_EQ(steps.size(), 10U);
  for (const auto& step : steps) EXPECT_FALSE(step.isMeasured);
}

TEST(ImuBuffer, TimeRunningBackwardsAndNotFinite_AreRefused) {
  ImuBuffer buffer;
  EXPECT_TRUE(buffer.add(sampleAt(1, 0)));
  EXPECT_FALSE(buffer.add(sampleAt(1, 0)));
  EXPECT_FALSE(buffer.add(sampleAt(0.5, 0)));
  EXPECT_FALSE(buffer.add(sampleAt(2, std::nan(""))));
  EXPECT_EQ(buffer.samples().size(), 1U);
}

TEST(ImuBuffer, Forgetting_KeepsWhatLaterTimesNeed) {
  ImuBuffer buffer = rampBuffer();
  const auto before = buffer.steps(core::durationNs(0.053), core::durationNs(0.09), 0.1);
  buffer.forgetBefore(core::durationNs(0.053));
  EXPECT_EQ(buffer.samples().size(), 6U);  // from 0.05 on
  const auto after = buffer.steps(core::durationNs(0.053), core::durationNs(0.09), 0.1);
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(after.front().angularRate_radps, before.front().angularRate_radps);
}

}  // namespace
}  // namespace s2s::odometry
