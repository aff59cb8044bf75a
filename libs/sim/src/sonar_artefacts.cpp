#include "s2s/sim/sonar_artefacts.h"

#include <cmath>

namespace s2s::sim {

namespace {

double fromDb(double level_db) { return std::pow(10, 0.1 * level_db); }

}  // namespace

ArtefactModel::ArtefactModel(const SonarOptions& o, const SonarGeometry& geometry, std::uint64_t deviceSeed)
    : options_(o),
      beams_(static_cast<std::size_t>(o.beamCount)),
      ranges_(static_cast<std::size_t>(o.rangeCount)),
      resolution_m_(o.maxRange_m / o.rangeCount),
      noisePower_(fromDb(o.noiseLevel_db)) {
  for (const double bearing : geometry.bearings_rad()) {
    const double u = bearing / o.artefacts.centreWidth_rad;
    haze_.push_back(static_cast<float>(std::exp(-0.5 * u * u)));
  }
  Random random(deviceSeed, 0x62616e64);
  for (std::size_t row = 0; row < ranges_; row += static_cast<std::size_t>(o.artefacts.bandRows))
    bandOffset_.push_back(o.artefacts.bandSigma_db * random.normal());
}

void ArtefactModel::apply(std::vector<float>& power, double t_s, Random& random) const {
  const SonarArtefacts& a = options_.artefacts;
  if (a.rowLeak) leakRows(power, random);
  if (a.crossTalk && a.otherRate_hz > 0) addCrossTalk(power, t_s, random);
  if (a.centreHaze) addCentreHaze(power, random);
  if (a.streaks) addStreaks(power, random);
  if (a.ringDown) addRingDown(power, random);
  if (a.banding) bandRows(power, random);
}

void ArtefactModel::leakRows(std::vector<float>& power, Random& random) const {
  const double share = fromDb(options_.artefacts.rowLeak_db) / static_cast<double>(beams_);
  for (std::size_t r = 0; r < ranges_; ++r) {
    float* row = &power[r * beams_];
    double sum = 0;
    for (std::size_t b = 0; b < beams_; ++b) sum += row[b];
    const auto leak = static_cast<float>(share * sum);
    for (std::size_t b = 0; b < beams_; ++b) row[b] += leak * static_cast<float>(2 * random.uniform());
  }
}

void ArtefactModel::addRingDown(std::vector<float>& power, Random& random) const {
  // The transducer's own ringing, falling by a constant number of decibels a metre, the same on all beams.
  const SonarArtefacts& a = options_.artefacts;
  for (std::size_t r = 0; r < ranges_; ++r) {
    const double range_m = (static_cast<double>(r) + 0.5) * resolution_m_;
    const double level = noisePower_ * fromDb(a.ringDown_db - a.ringDownDecay_dbPerM * range_m);
    if (level < 1e-2 * noisePower_) break;
    for (std::size_t b = 0; b < beams_; ++b)
      power[r * beams_ + b] += static_cast<float>(level * (0.5 + random.uniform()));
  }
}

void ArtefactModel::addCentreHaze(std::vector<float>& power, Random& random) const {
  const double level = noisePower_ * fromDb(options_.artefacts.centreHaze_db);
  for (std::size_t r = 0; r < ranges_; ++r)
    for (std::size_t b = 0; b < beams_; ++b)
      if (haze_[b] > 1e-3f) power[r * beams_ + b] += static_cast<float>(level * random.exponential()) * haze_[b];
}

void ArtefactModel::addStreaks(std::vector<float>& power, Random& random) const {
  const SonarArtefacts& a = options_.artefacts;
  const auto count = static_cast<int>(2 * a.streaksPerPing * random.uniform());
  for (int i = 0; i < count; ++i) {
    const auto row = static_cast<std::size_t>(random.uniform() * static_cast<double>(ranges_));
    const auto first = static_cast<std::size_t>(random.uniform() * static_cast<double>(beams_));
    const auto width = static_cast<std::size_t>(1 + a.streakBeams * random.exponential());
    const double level = noisePower_ * fromDb(a.streak_db) * random.exponential();
    for (std::size_t b = first; b < std::min(beams_, first + width); ++b)
      power[row * beams_ + b] += static_cast<float>(level * (0.5 + random.uniform()));
  }
}

void ArtefactModel::addCrossTalk(std::vector<float>& power, double t_s, Random& random) const {
  const SonarArtefacts& a = options_.artefacts;
  const double window_s = 2 * options_.maxRange_m / options_.soundSpeed_mps;
  const double next = std::ceil((t_s - a.otherOffset_s) * a.otherRate_hz - 1e-9);
  const double delay_s = std::max(0.0, next / a.otherRate_hz + a.otherOffset_s - t_s);
  if (delay_s >= window_s || random.uniform() > a.crossTalkShare) return;
  // The other's transmission comes straight in: a ring at half the delay's way, on all beams, with a short tail.
  const double ring_m = 0.5 * delay_s * options_.soundSpeedAssumed_mps, tail_m = 0.06;
  const double level = noisePower_ * fromDb(a.crossTalk_db);
  for (auto r = static_cast<std::size_t>(ring_m / resolution_m_); r < ranges_; ++r) {
    const double after_m = (static_cast<double>(r) + 0.5) * resolution_m_ - ring_m;
    if (after_m > 6 * tail_m) break;
    for (std::size_t b = 0; b < beams_; ++b)
      power[r * beams_ + b] +=
          static_cast<float>(level * std::exp(-std::max(0.0, after_m) / tail_m) * random.exponential());
  }
}

void ArtefactModel::bandRows(std::vector<float>& power, Random& random) const {
  const auto rows = static_cast<std::size_t>(options_.artefacts.bandRows);
  for (std::size_t band = 0; band < bandOffset_.size(); ++band) {
    const auto gain =
        static_cast<float>(fromDb(bandOffset_[band] + 0.3 * options_.artefacts.bandSigma_db * random.normal()));
    const std::size_t end = std::min(ranges_, (band + 1) * rows);
    for (std::size_t i = band * rows * beams_; i < end * beams_; ++i) power[i] *= gain;
  }
}

}  // namespace s2s::sim
