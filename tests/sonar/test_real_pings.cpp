#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "oculus_pings.h"
#include "s2s/sonar/sonar_device.h"

namespace s2s::sonar {
namespace {

const std::string kPings = std::string(S2S_DATA_DIR) + "/oculus/three_pings_8bit.raw";

/// Where a beam's raw echo, averaged over `window` bins, first reaches half of its strongest: a person's idea of where
/// the bottom begins, independent of the chain.
double halfHeightRange_m(const obs::CObservationImagingSonar& ping, std::size_t beam, double minRange_m) {
  constexpr std::size_t kWindow = 21;
  std::vector<double> mean(ping.rangeCount, 0);
  for (std::size_t bin = kWindow / 2; bin + kWindow / 2 < ping.rangeCount; ++bin)
    for (std::size_t k = bin - kWindow / 2; k <= bin + kWindow / 2; ++k)
      mean[bin] += static_cast<double>(ping.sample(k, beam)) / kWindow;
  const auto first = static_cast<std::ptrdiff_t>(minRange_m / ping.rangeResolution_m);
  const double strongest = *std::max_element(mean.begin() + first, mean.end());
  for (auto bin = static_cast<std::size_t>(first); bin < mean.size(); ++bin)
    if (mean[bin] >= 0.5 * strongest) return ping.binRange_m(bin);
  return ping.maxRange_m();
}

TEST(RealPings, OculusBottom_IsWhereTheRawEchoRises) {
  if (!std::filesystem::exists(kPings)) GTEST_SKIP() << "no recorded Oculus pings at " << kPings;
  const auto pings = test::readOculusPings(kPings);
  ASSERT_EQ(pings.size(), 3u);
  const SonarDevice device(horizontalDefaults());
  for (const auto& ping : pings) {
    ASSERT_EQ(ping.rangeCount, 703u);
    ASSERT_EQ(ping.beamCount, 256u);
    const auto scan = device.process(ping).lineScan;
    std::vector<double> differences;
    for (const auto& r : scan.returns)
      differences.push_back(std::abs(r.range_m - halfHeightRange_m(ping, r.beam, 0.5)));
    ASSERT_GE(differences.size(), 240u);  // the bottom spans the whole fan
    std::sort(differences.begin(), differences.end());
    std::printf("leading edge against half height: median %.3f m, 90%% %.3f m\n", differences[differences.size() / 2],
                differences[differences.size() * 9 / 10]);
    // Speckle has a grain of a few centimetres here (2.8 mm bins); the band itself is 0.4 m wide at 0.8 m.
    EXPECT_LE(differences[differences.size() / 2], 0.04);
    EXPECT_LE(differences[differences.size() * 9 / 10], 0.15);
  }
}

TEST(RealPings, OculusImage_KeepsTheBottomAndClearsTheWater) {
  if (!std::filesystem::exists(kPings)) GTEST_SKIP() << "no recorded Oculus pings at " << kPings;
  for (const auto& ping : test::readOculusPings(kPings)) {
    const auto processed = SonarDevice(horizontalDefaults()).process(ping);
    const auto row = [&](double range_m) { return static_cast<int>(range_m / ping.rangeResolution_m); };
    const auto share = [&](double from_m, double to_m) {
      const cv::Mat part = processed.image.rowRange(row(from_m), row(to_m));
      return static_cast<double>(cv::countNonZero(part)) / static_cast<double>(part.total());
    };
    EXPECT_LT(share(0.1, 0.45), 0.005);  // open water in front of the bottom, seen by eye in all three pings
    EXPECT_GT(share(0.85, 1.0), 0.25);   // the bright band, thinned by mask and opening
    EXPECT_LT(share(1.5, 1.9), 0.02);    // beyond it mere noise
  }
}

}  // namespace
}  // namespace s2s::sonar
