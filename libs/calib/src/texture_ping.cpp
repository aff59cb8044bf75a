#include <algorithm>

#include "s2s/calib/texture.h"

namespace s2s::calib {

namespace {

constexpr std::size_t kBeams = 2, kBins = 2;  // averaged: well below the resolution

/// A ping of averaged samples, and sums over rectangles of it.
class Samples {
 public:
  explicit Samples(const obs::CObservationImagingSonar& ping)
      : beams_(ping.beamCount / kBeams),
        bins_(ping.rangeCount / kBins),
        values_(beams_ * bins_),
        sums_(values_.size()) {
    for (std::size_t bin = 0; bin < bins_ * kBins; ++bin)
      for (std::size_t beam = 0; beam < beams_ * kBeams; ++beam)
        values_[beam / kBeams * bins_ + bin / kBins] +=
            static_cast<float>(ping.sample(bin, beam)) / static_cast<float>(kBeams * kBins);
    sums_.assign((beams_ + 1) * (bins_ + 1), 0);
    for (std::size_t beam = 0; beam < beams_; ++beam)
      for (std::size_t bin = 0; bin < bins_; ++bin)
        sum(beam + 1, bin + 1) =
            static_cast<double>(at(beam, bin)) + sum(beam, bin + 1) + sum(beam + 1, bin) - sum(beam, bin);
  }

  std::size_t beams() const { return beams_; }
  std::size_t bins() const { return bins_; }
  float at(std::size_t beam, std::size_t bin) const { return values_[beam * bins_ + bin]; }

  float mean(std::size_t beam, std::size_t bin, std::size_t beamReach, std::size_t binReach) const {
    const std::size_t b0 = beam - std::min(beam, beamReach), b1 = std::min(beams_, beam + beamReach + 1);
    const std::size_t r0 = bin - std::min(bin, binReach), r1 = std::min(bins_, bin + binReach + 1);
    const double total = sum(b1, r1) - sum(b0, r1) - sum(b1, r0) + sum(b0, r0);
    return static_cast<float>(total / static_cast<double>((b1 - b0) * (r1 - r0)));
  }

 private:
  double& sum(std::size_t beam, std::size_t bin) { return sums_[beam * (bins_ + 1) + bin]; }
  double sum(std::size_t beam, std::size_t bin) const { return sums_[beam * (bins_ + 1) + bin]; }

  std::size_t beams_, bins_;
  std::vector<float> values_;
  std::vector<double> sums_;
};

/// The band around the strongest mean echo of a beam, as contrasts.
void fillBeam(const std::vector<float>& means, const Samples& samples, std::size_t beam, std::size_t firstBin,
              const TextureOptions& options, TexturePing::Beam& out) {
  if (firstBin >= means.size()) return;
  const auto peak = std::max_element(means.begin() + static_cast<std::ptrdiff_t>(firstBin), means.end());
  const float least = std::max(1.0F, static_cast<float>(options.bandLevel) * *peak);
  auto first = static_cast<std::size_t>(peak - means.begin()), last = first;
  while (first > firstBin && means[first - 1] >= least) --first;
  while (last + 1 < means.size() && means[last + 1] >= least) ++last;
  out.firstBin = static_cast<std::uint16_t>(first);
  if (*peak <= least) return;
  for (std::size_t bin = first; bin <= last; ++bin) {
    const float contrast = samples.at(beam, bin) / means[bin] - 1;
    out.contrast.push_back(static_cast<std::int8_t>(kContrastScale * std::clamp(contrast, -2.0F, 2.0F)));
  }
}

}  // namespace

TexturePing texturePing(const obs::CObservationImagingSonar& ping, core::TimeNs time, const TextureOptions& options) {
  TexturePing result;
  result.time = time;
  if (ping.beamCount < 8 * kBeams || ping.rangeCount < 8 * kBins) return result;
  const Samples samples(ping);
  result.step_m = kBins * ping.rangeResolution_m;
  result.firstRange_m = ping.rangeOffset_m + 0.5 * result.step_m;
  const double fan_rad = std::abs(ping.bearings_rad.back() - ping.bearings_rad.front());
  const auto beamReach =
      static_cast<std::size_t>(options.meanReach_rad / fan_rad * static_cast<double>(samples.beams()));
  const auto binReach = static_cast<std::size_t>(options.meanReach_m / result.step_m);
  const auto firstBin =
      static_cast<std::size_t>(std::max(0.0, (options.minRange_m - result.firstRange_m) / result.step_m));
  std::vector<float> means(samples.bins());
  for (std::size_t beam = 0; beam < samples.beams(); ++beam) {
    for (std::size_t bin = 0; bin < samples.bins(); ++bin) means[bin] = samples.mean(beam, bin, beamReach, binReach);
    TexturePing::Beam out;
    out.bearing_rad = 0.5F * (ping.bearings_rad[beam * kBeams] + ping.bearings_rad[beam * kBeams + kBeams - 1]);
    fillBeam(means, samples, beam, firstBin, options, out);
    result.beams.push_back(std::move(out));
  }
  return result;
}

}  // namespace s2s::calib
