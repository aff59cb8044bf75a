#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "s2s/core/error.h"
#include "s2s/sonar/preprocess.h"
#include "synthetic_pings.h"

namespace s2s::sonar {
namespace {

using test::emptyPing;
using test::setSample;

obs::CObservationImagingSonar randomPing(unsigned seed, std::uint8_t bytes = 1) {
  auto ping = emptyPing(40, 30, 60 * test::kDeg, bytes);
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::uint32_t> sample(0, ping.maxSample());
  for (std::size_t bin = 0; bin < ping.rangeCount; ++bin)
    for (std::size_t beam = 0; beam < ping.beamCount; ++beam) setSample(ping, bin, beam, sample(random));
  return ping;
}

cv::Mat runSteps(const obs::CObservationImagingSonar& ping, const std::vector<PreprocessStep>& steps,
                 PreprocessOptions options = {}) {
  options.steps = steps;
  return Preprocessor(options).process(ping);
}

TEST(Preprocess, NoSteps_KeepsAnEightBitImage) {
  const auto ping = randomPing(1);
  const cv::Mat image = runSteps(ping, {});
  ASSERT_EQ(image.rows, 30);
  ASSERT_EQ(image.cols, 40);
  EXPECT_TRUE(std::equal(ping.samples.begin(), ping.samples.end(), image.data));
}

TEST(Preprocess, RowQuantile_SubtractsTheSortedRowsValue) {
  const auto ping = randomPing(2);
  const cv::Mat image = runSteps(ping, {PreprocessStep::RowQuantile});
  for (int bin = 0; bin < image.rows; ++bin) {
    std::vector<int> row;
    for (std::size_t beam = 0; beam < 40; ++beam)
      row.push_back(static_cast<int>(ping.sample(static_cast<std::size_t>(bin), beam)));
    auto sorted = row;
    std::sort(sorted.begin(), sorted.end());
    const int quantile = sorted[3];  // floor(0.1 * 39)
    for (int beam = 0; beam < 40; ++beam)
      EXPECT_EQ(image.at<std::uint8_t>(bin, beam), std::max(0, row[static_cast<std::size_t>(beam)] - quantile));
  }
}

TEST(Preprocess, RowMean_RemovesAStripeButKeepsATarget) {
  auto ping = emptyPing(100, 20);
  for (std::size_t beam = 0; beam < 100; ++beam) setSample(ping, 7, beam, 90);  // an artefact across the row
  setSample(ping, 12, 50, 200);
  const cv::Mat image = runSteps(ping, {PreprocessStep::RowMean});
  EXPECT_EQ(cv::countNonZero(image.row(7)), 0);
  EXPECT_EQ(image.at<std::uint8_t>(12, 50), 198);  // its own row's mean is 2
}

TEST(Preprocess, CenterRemoval_ClearsWeakPixelsOfTheMiddleOnly) {
  auto ping = emptyPing(60, 10, 60 * test::kDeg);  // one beam a degree
  for (std::size_t beam = 0; beam < 60; ++beam) setSample(ping, 5, beam, 30);
  setSample(ping, 5, 30, 250);
  const cv::Mat image = runSteps(ping, {PreprocessStep::CenterRemoval});  // 20 % of 250 is 50
  for (int beam = 0; beam < 60; ++beam) {
    const bool central = beam >= 20 && beam < 40;  // bearings -9.5 to 9.5 degrees
    EXPECT_EQ(image.at<std::uint8_t>(5, beam), beam == 30 ? 250 : central ? 0 : 30) << beam;
  }
}

TEST(Preprocess, OtsuMask_SplitsWhereTheVarianceBetweenClassesIsLargest) {
  const auto ping = randomPing(3);
  std::vector<int> values(ping.samples.begin(), ping.samples.end());
  int best = 0;
  double bestBetween = -1;
  for (int t = 0; t < 255; ++t) {
    double n[2] = {0, 0}, sum[2] = {0, 0};
    for (const int v : values) {
      ++n[v > t];
      sum[v > t] += v;
    }
    if (n[0] == 0 || n[1] == 0) continue;
    const double d = sum[0] / n[0] - sum[1] / n[1], between = n[0] * n[1] * d * d;
    if (between > bestBetween) {
      bestBetween = between;
      best = t;
    }
  }
  const cv::Mat image = runSteps(ping, {PreprocessStep::OtsuMask});
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(image.data[i], values[i] > best ? values[i] : 0);
}

TEST(Preprocess, Normalise_StretchesToFullScale) {
  auto ping = emptyPing(10, 10);
  setSample(ping, 1, 1, 10);
  setSample(ping, 2, 2, 50);
  const cv::Mat image = runSteps(ping, {PreprocessStep::Normalise});
  EXPECT_EQ(image.at<std::uint8_t>(2, 2), 255);
  EXPECT_EQ(image.at<std::uint8_t>(1, 1), 51);
  EXPECT_EQ(image.at<std::uint8_t>(0, 0), 0);
}

TEST(Preprocess, NormaliseByQuantile_KeepsOneGlintFromDarkeningAll) {
  auto ping = emptyPing(50, 50);
  for (std::size_t i = 0; i < 50; ++i) setSample(ping, i, i, 60);
  setSample(ping, 10, 40, 255);
  PreprocessOptions options;
  options.normaliseQuantile = 0.95;
  EXPECT_EQ(runSteps(ping, {PreprocessStep::Normalise}, options).at<std::uint8_t>(20, 20), 255);
  options.normaliseQuantile = 1;
  EXPECT_EQ(runSteps(ping, {PreprocessStep::Normalise}, options).at<std::uint8_t>(20, 20), 60);
}

TEST(Preprocess, Opening_EqualsMinimumThenMaximumAlongRange) {
  const auto ping = randomPing(4);
  const cv::Mat image = runSteps(ping, {PreprocessStep::Opening});
  const auto at = [&](int bin, int beam) {
    return static_cast<int>(ping.sample(static_cast<std::size_t>(bin), static_cast<std::size_t>(beam)));
  };
  const auto eroded = [&](int bin, int beam) {
    int least = 255;
    for (int r = std::max(0, bin - 1); r <= std::min(29, bin + 1); ++r) least = std::min(least, at(r, beam));
    return least;
  };
  for (int bin = 0; bin < 30; ++bin)
    for (int beam = 0; beam < 40; ++beam) {
      int most = 0;
      for (int r = std::max(0, bin - 1); r <= std::min(29, bin + 1); ++r) most = std::max(most, eroded(r, beam));
      EXPECT_EQ(image.at<std::uint8_t>(bin, beam), most) << bin << " " << beam;
    }
}

TEST(Preprocess, Median_TakesTheMiddleOfNine) {
  const auto ping = randomPing(5);
  const cv::Mat image = runSteps(ping, {PreprocessStep::Median});
  for (int bin = 1; bin < 29; ++bin)
    for (int beam = 1; beam < 39; ++beam) {
      std::vector<std::uint32_t> nine;
      for (int r = bin - 1; r <= bin + 1; ++r)
        for (int c = beam - 1; c <= beam + 1; ++c)
          nine.push_back(ping.sample(static_cast<std::size_t>(r), static_cast<std::size_t>(c)));
      std::sort(nine.begin(), nine.end());
      EXPECT_EQ(image.at<std::uint8_t>(bin, beam), nine[4]);
    }
}

TEST(Preprocess, SixteenBitDevice_GivesTheImageOfItsEightBitTwin) {
  const auto ping8 = randomPing(6);
  auto ping16 = emptyPing(40, 30, 60 * test::kDeg, 2);
  for (std::size_t bin = 0; bin < 30; ++bin)
    for (std::size_t beam = 0; beam < 40; ++beam) setSample(ping16, bin, beam, 257 * ping8.sample(bin, beam));
  for (const auto& options : {PreprocessOptions{}, blueViewPreprocess()}) {
    const cv::Mat a = Preprocessor(options).process(ping8), b = Preprocessor(options).process(ping16);
    ASSERT_EQ(b.depth(), CV_8U);
    // The 8-bit path rounds a row's mean and stretches afterwards: a level or two; a pixel on Otsu's threshold may fall
    // to either side, so a few may differ by more.
    cv::Mat difference;
    cv::absdiff(a, b, difference);
    EXPECT_LE(cv::countNonZero(difference > 2), 12);
  }
}

TEST(Preprocess, Stages_ShowEachStepInOrder) {
  std::vector<PreprocessStage> stages;
  const cv::Mat image = Preprocessor().process(randomPing(7), &stages);
  ASSERT_EQ(stages.size(), 5u);
  EXPECT_EQ(stages.front().name, "raw");
  EXPECT_EQ(stages[1].name, "row_quantile");
  EXPECT_EQ(cv::norm(stages.back().image, image, cv::NORM_INF), 0);
}

TEST(Preprocess, EmptyPing_GivesAnEmptyImage) {
  EXPECT_TRUE(Preprocessor().process(obs::CObservationImagingSonar()).empty());
}

TEST(Preprocess, BlankPing_StaysBlank) {
  for (const auto& options : {PreprocessOptions{}, blueViewPreprocess()})
    EXPECT_EQ(cv::countNonZero(Preprocessor(options).process(emptyPing(20, 20))), 0);
}

TEST(Preprocess, WrongOptionsAndPings_AreRefused) {
  PreprocessOptions options;
  options.rowQuantile = 1.5;
  EXPECT_THROW(Preprocessor{options}, core::ConfigError);
  options = {};
  options.medianSize = 4;
  EXPECT_THROW(Preprocessor{options}, core::ConfigError);
  auto ping = randomPing(8);
  ping.samples.pop_back();
  EXPECT_THROW(Preprocessor().process(ping), core::InputError);
}

}  // namespace
}  // namespace s2s::sonar
