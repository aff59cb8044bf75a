#include <cmath>

#include "s2s/sim/beam_pattern.h"
#include "s2s/sim/sonar_receiver.h"

namespace s2s::sim {

namespace {

/// out[i] += weight[i] * in[i]
__attribute__((target_clones("default", "avx2"))) void multiplyAdd(const float* weight, const float* in, float* out,
                                                                   std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] += weight[i] * in[i];
}

/// out[i] += weight * in[i]
__attribute__((target_clones("default", "avx2"))) void scaleAdd(float weight, const float* in, float* out,
                                                                std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] += weight * in[i];
}

/// Scatterers of the given power: re and im become standard normals times sqrt(power / 2).
__attribute__((target_clones("default", "avx2"))) void scaleByPower(const float* power, float* re, float* im,
                                                                    std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float amplitude = std::sqrt(0.5f * power[i]);
    re[i] *= amplitude;
    im[i] *= amplitude;
  }
}

__attribute__((target_clones("default", "avx2"))) void addSquares(const float* re, const float* im, float scale,
                                                                  float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] += scale * (re[i] * re[i] + im[i] * im[i]);
}

constexpr double kPatternReach = 7;  // in x of arrayPattern: the main lobe and five side lobes on each side

/// A Gaussian pulse whose amplitude is one half at +-length/2.
std::vector<float> makePulse(double length_m, double resolution_m) {
  if (length_m <= 0) return {1.0f};
  const double sigma = 0.5 * length_m / std::sqrt(2 * std::log(2.0)) / resolution_m;
  const int half = static_cast<int>(std::ceil(3 * sigma));
  std::vector<float> pulse;
  for (int i = -half; i <= half; ++i) pulse.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
  return pulse;
}

}  // namespace

BeamFormer::BeamFormer(const SonarOptions& o, const SonarGeometry& geometry)
    : options_(o),
      beams_(static_cast<std::size_t>(o.beamCount)),
      ranges_(static_cast<std::size_t>(o.rangeCount)),
      pulse_(makePulse(o.pulseLength_m, o.maxRange_m / o.rangeCount)) {
  const auto& bearings = geometry.bearings_rad();
  const double perSine = 2 * halfPowerPoint(o.taper) / (2 * std::sin(0.5 * o.beamWidth_rad));  // x per sin(bearing)
  if (o.beamPattern) {
    const std::size_t c = beams_ / 2;
    const double step = std::abs(std::sin(bearings[c]) - std::sin(bearings[c - 1])) * perSine;
    reach_ = std::min(beams_ - 1, static_cast<std::size_t>(std::ceil(kPatternReach / step)));
  }
  const std::size_t taps = 2 * reach_ + 1;
  weights_.assign(taps * beams_, 0.0f);
  energy_.assign(beams_, 0.0);
  for (std::size_t k = 0; k < taps; ++k)
    for (std::size_t b = 0; b < beams_; ++b) {
      const std::size_t from = b + k;  // beam index plus reach
      if (from < reach_ || from - reach_ >= beams_) continue;
      const double x = (std::sin(bearings[from - reach_]) - std::sin(bearings[b])) * perSine;
      const double w = o.beamPattern ? arrayPattern(x, o.taper) : 1;
      weights_[k * beams_ + b] = static_cast<float>(w);
      energy_[b] += w * w;
    }
  double pulseEnergy = 0;
  for (const float p : pulse_) pulseEnergy += static_cast<double>(p) * p;
  for (float& p : pulse_) p = static_cast<float>(p / std::sqrt(pulseEnergy));  // a uniform field keeps its level
  squared_ = weights_;
  for (float& w : squared_) w *= w;
}

void BeamFormer::blurBearing(const float* padded, float* out, bool squared) const {
  const std::vector<float>& w = squared ? squared_ : weights_;
  std::fill(out, out + beams_, 0.0f);
  for (std::size_t k = 0; k <= 2 * reach_; ++k) multiplyAdd(&w[k * beams_], padded + k, out, beams_);
}

void BeamFormer::blurRange(std::vector<float>& image, bool squared) const {
  if (pulse_.size() == 1) return;
  const std::size_t half = pulse_.size() / 2;
  std::vector<float> result(image.size(), 0.0f);
  for (std::size_t r = 0; r < ranges_; ++r)
    for (std::size_t j = 0; j < pulse_.size(); ++j) {
      if (r + j < half || r + j - half >= ranges_) continue;
      const float w = squared ? pulse_[j] * pulse_[j] : pulse_[j];
      scaleAdd(w, &image[(r + j - half) * beams_], &result[r * beams_], beams_);
    }
  image.swap(result);
}

void BeamFormer::form(const EchoImage& echo, std::uint64_t key, std::vector<float>& power) const {
  const std::size_t pixels = ranges_ * beams_;
  std::vector<float> source = echo.power, padded(beams_ + 2 * reach_, 0.0f);
  if (options_.noise) {
    // Noise enters at the elements, so it passes through the same beams: given so that a pixel gets the wanted level.
    const double level = std::pow(10, 0.1 * options_.noiseLevel_db);
    for (std::size_t b = 0; b < beams_; ++b) {
      const auto n = static_cast<float>(level / energy_[b]);
      for (std::size_t r = 0; r < ranges_; ++r) source[r * beams_ + b] += n;
    }
  }
  const auto blur = [&](std::vector<float>& image, bool squared) {
    for (std::size_t r = 0; r < ranges_; ++r) {
      std::copy_n(&image[r * beams_], beams_, padded.begin() + static_cast<std::ptrdiff_t>(reach_));
      blurBearing(padded.data(), &image[r * beams_], squared);
    }
    blurRange(image, squared);
  };
  if (!options_.speckle) {
    blur(source, true);
    power.swap(source);
    return;
  }
  power.assign(pixels, 0.0f);
  std::vector<float> re(pixels), im(pixels);
  for (int look = 0; look < options_.looks; ++look) {
    fillComplexNormals(mixBits(key + static_cast<std::uint64_t>(look)), pixels, re.data(), im.data());
    scaleByPower(source.data(), re.data(), im.data(), pixels);
    blur(re, false);
    blur(im, false);
    addSquares(re.data(), im.data(), 1.0f / static_cast<float>(options_.looks), power.data(), pixels);
  }
}

}  // namespace s2s::sim
