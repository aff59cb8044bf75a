#include <gtest/gtest.h>

#include <numeric>

#include "s2s/sim/sonar_artefacts.h"
#include "s2s/sim/sonar_receiver.h"
#include "sim_support.h"

using namespace s2s;
using namespace s2s::test;

namespace {

sim::SonarOptions smallSonar() {
  sim::SonarOptions o = idealSonar();
  o.beamCount = 256;
  o.rangeCount = 600;
  o.speckle = true;
  return o;
}

sim::EchoImage uniformEcho(const sim::SonarOptions& o, float power) {
  sim::EchoImage echo;
  echo.reset(static_cast<std::size_t>(o.rangeCount), static_cast<std::size_t>(o.beamCount));
  std::fill(echo.power.begin(), echo.power.end(), power);
  return echo;
}

/// Powers of pixels so far apart that beam and pulse do not tie them together, over the expected mean.
std::vector<double> independentPixels(const sim::SonarOptions& o, const std::vector<float>& power, double mean) {
  std::vector<double> samples;
  for (int bin = 20; bin < o.rangeCount - 20; bin += 10)
    for (int beam = 60; beam < o.beamCount - 60; beam += 15)
      samples.push_back(power.data()[bin * o.beamCount + beam] / mean);
  return samples;
}

}  // namespace

TEST(BeamFormer, SpeckleOfOneLook_HasRayleighAmplitudes) {
  const sim::SonarOptions o = smallSonar();
  const sim::BeamFormer former(o, sim::SonarGeometry(o));
  std::vector<float> power;
  former.form(uniformEcho(o, 1), 77, power);
  const auto samples = independentPixels(o, power, former.responseEnergy(128));
  // A Rayleigh amplitude is an exponential power.
  EXPECT_LT(kolmogorovDistance(samples, [](double x) { return 1 - std::exp(-x); }), kolmogorovLimit(samples.size()));
}

TEST(BeamFormer, SpeckleOfThreeLooks_IsGammaDistributed) {
  sim::SonarOptions o = smallSonar();
  o.looks = 3;
  const sim::BeamFormer former(o, sim::SonarGeometry(o));
  std::vector<float> power;
  former.form(uniformEcho(o, 1), 78, power);
  const auto samples = independentPixels(o, power, former.responseEnergy(128));
  const auto gamma3 = [](double x) { return 1 - std::exp(-3 * x) * (1 + 3 * x + 4.5 * x * x); };
  EXPECT_LT(kolmogorovDistance(samples, gamma3), kolmogorovLimit(samples.size()));
}

TEST(BeamFormer, PointTarget_DrawsTheBeamPattern) {
  sim::SonarOptions o = smallSonar();
  o.speckle = false;
  const sim::SonarGeometry geometry(o);
  const sim::BeamFormer former(o, geometry);
  sim::EchoImage echo = uniformEcho(o, 0);
  echo.at(300, 128) = 1;
  std::vector<float> power;
  former.form(echo, 0, power);
  const auto at = [&](int beam) { return power.data()[300 * o.beamCount + beam] / power[300 * 256 + 128]; };
  int wide = 128;
  while (at(wide) > 0.5f) ++wide;
  const double halfWidth = geometry.bearings_rad()[static_cast<std::size_t>(wide)] - geometry.bearings_rad()[128];
  // The first beam below one half lies within one beam spacing (0.41 degrees) beyond half the beam's width.
  EXPECT_GT(halfWidth, 0.5 * o.beamWidth_rad);
  EXPECT_LT(halfWidth, 0.5 * o.beamWidth_rad + geometry.cellWidth_rad(128));
  EXPECT_GT(at(128 + 7), 0);  // side lobes draw an arc
  EXPECT_EQ(power[100 * 256 + 128], 0);
}

TEST(BeamFormer, PulseSpreadsATarget_ByItsLength) {
  sim::SonarOptions o = smallSonar();
  o.speckle = false;
  o.pulseLength_m = 0.2;
  const sim::BeamFormer former(o, sim::SonarGeometry(o));
  sim::EchoImage echo = uniformEcho(o, 0);
  echo.at(300, 128) = 1;
  std::vector<float> power;
  former.form(echo, 0, power);
  const auto at = [&](int bin) { return power.data()[bin * 256 + 128] / power[300 * 256 + 128]; };
  // -6 dB at half the length on both sides: 0.1 m are six bins.
  EXPECT_NEAR(10 * std::log10(at(306)), -6.02, 0.1);
  EXPECT_NEAR(at(294), at(306), 1e-6);
}

TEST(BeamFormer, NoiseAlone_HasItsLevelInEveryBeam) {
  sim::SonarOptions o = smallSonar();
  o.noise = true;
  o.noiseLevel_db = 60;
  const sim::BeamFormer former(o, sim::SonarGeometry(o));
  std::vector<float> power;
  former.form(uniformEcho(o, 0), 5, power);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < power.size(); i += 1, ++count) sum += power[i];
  // 600 x 256 pixels, about 30 tied together: 5000 independent ones, 1.4 %; the array's edges see fewer elements.
  EXPECT_NEAR(10 * std::log10(sum / count), 60, 0.3);
}

TEST(SonarReceiver, TimeVaryingGain_LevelsWhatItIsMadeFor) {
  sim::SonarOptions o = smallSonar();
  o.gamma = 1;
  o.tvgSpreading_db = 30;
  o.tvgAbsorption_dbPerM = 0.5;
  o.gain_db = -40;
  o.blanking_m = 0.5;
  std::vector<float> power;
  for (int bin = 0; bin < o.rangeCount; ++bin) {
    const double r = (bin + 0.5) * o.maxRange_m / o.rangeCount;
    const double level_db = 34 - 30 * std::log10(r) - 0.5 * r;
    power.insert(power.end(), 4, static_cast<float>(std::pow(10, 0.1 * level_db)));
  }
  std::vector<std::uint8_t> samples;
  sim::SonarReceiver(o).quantize(power, 4, samples);
  const int blanked = static_cast<int>(0.5 * o.rangeCount / o.maxRange_m);
  EXPECT_EQ(samples[0], 0);
  EXPECT_EQ(samples[static_cast<std::size_t>(4 * (blanked - 1))], 0);
  for (int bin = blanked + 1; bin < o.rangeCount; bin += 50)
    EXPECT_NEAR(samples[static_cast<std::size_t>(4 * bin)], 255 * std::pow(10, -6.0 / 20), 1);
}

TEST(SonarReceiver, StrongEcho_Saturates_AndGammaCompresses) {
  sim::SonarOptions o = smallSonar();
  o.tvgSpreading_db = o.tvgAbsorption_dbPerM = o.gain_db = o.blanking_m = 0;
  o.rangeCount = 1;
  std::vector<std::uint8_t> samples;
  for (const double gamma : {0.5, 0.7, 1.0}) {
    o.gamma = gamma;
    sim::SonarReceiver(o).quantize({0.0f, 0.0625f, 1.0f, 100.0f}, 4, samples);
    EXPECT_EQ(samples[0], 0);
    EXPECT_NEAR(samples[1], 255 * std::pow(0.25, gamma), 1);  // amplitude 0.25
    EXPECT_EQ(samples[2], 255);
    EXPECT_EQ(samples[3], 255);
  }
}

TEST(ArtefactModel, EachEffectSwitchedOff_LeavesThePowers) {
  const sim::SonarOptions o = smallSonar();
  std::vector<float> power(static_cast<std::size_t>(o.rangeCount * o.beamCount), 3.0f);
  const auto before = power;
  sim::Random random(1);
  sim::ArtefactModel(o, sim::SonarGeometry(o), 1).apply(power, 0, random);
  EXPECT_EQ(power, before);
}

TEST(ArtefactModel, CrossTalk_LiesAtHalfTheWayOfTheDelay) {
  sim::SonarOptions o = smallSonar();
  o.artefacts.crossTalk = true;
  o.artefacts.crossTalkShare = 1;
  o.artefacts.otherRate_hz = 10;
  o.artefacts.otherOffset_s = 0.029;
  std::vector<float> power(static_cast<std::size_t>(o.rangeCount * o.beamCount), 0.0f);
  sim::Random random(1);
  sim::ArtefactModel(o, sim::SonarGeometry(o), 1).apply(power, 0.121, random);  // the other one follows after 8 ms
  const int ring = static_cast<int>(0.004 * o.soundSpeedAssumed_mps * o.rangeCount / o.maxRange_m);
  EXPECT_EQ(power[static_cast<std::size_t>((ring - 1) * o.beamCount + 50)], 0);
  EXPECT_GT(power[static_cast<std::size_t>((ring + 1) * o.beamCount + 50)], 0);
  std::fill(power.begin(), power.end(), 0.0f);
  sim::ArtefactModel(o, sim::SonarGeometry(o), 1).apply(power, 0.05, random);  // it is silent while this one listens
  EXPECT_EQ(std::accumulate(power.begin(), power.end(), 0.0f), 0);
}

TEST(ArtefactModel, CentreHaze_StaysInTheCentre) {
  sim::SonarOptions o = smallSonar();
  o.artefacts.centreHaze = true;
  std::vector<float> power(static_cast<std::size_t>(o.rangeCount * o.beamCount), 0.0f);
  sim::Random random(1);
  sim::ArtefactModel(o, sim::SonarGeometry(o), 1).apply(power, 0, random);
  EXPECT_GT(power[128], 0);
  EXPECT_EQ(power[5], 0);
}
