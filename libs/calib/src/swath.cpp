#include "s2s/calib/swath.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace s2s::calib {

namespace {

/// Samples of a ping as floats, a beam after the other.
struct Beams {
  std::size_t bins = 0, beams = 0;
  std::vector<float> values;
  float* beam(std::size_t b) { return values.data() + b * bins; }
  const float* beam(std::size_t b) const { return values.data() + b * bins; }
};

float quantile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// The ping in two forms, free of the noise floor.
struct Images {
  Beams level;     ///< sample less the row's floor
  Beams contrast;  ///< the same over the row's floor: the noise of an amplitude is as large as its level
};

/// Takes each beam's own floor off, which artefacts over groups of beams leave.
void subtractBeamFloor(Beams& image, std::size_t firstBin) {
  std::vector<float> column;
  for (std::size_t b = 0; b < image.beams; ++b) {
    column.assign(image.beam(b) + firstBin, image.beam(b) + image.bins);
    const float floor = quantile(column, 0.3);
    for (std::size_t bin = 0; bin < image.bins; ++bin) image.beam(b)[bin] -= floor;
  }
}

Images withoutFloor(const obs::CObservationImagingSonar& ping, std::size_t firstBin, double floorQuantile) {
  Images images{{ping.rangeCount, ping.beamCount, {}}, {ping.rangeCount, ping.beamCount, {}}};
  images.level.values.resize(images.level.bins * images.level.beams);
  images.contrast.values.resize(images.level.values.size());
  std::vector<float> row(ping.beamCount), floors(ping.rangeCount);
  for (std::size_t bin = 0; bin < ping.rangeCount; ++bin) {
    for (std::size_t b = 0; b < ping.beamCount; ++b)
      row[b] = images.level.beam(b)[bin] = static_cast<float>(ping.sample(bin, b));
    floors[bin] = quantile(row, floorQuantile);
  }
  std::vector<float> sorted(floors.begin() + static_cast<std::ptrdiff_t>(firstBin), floors.end());
  const float least =
      std::max(1.0F, 0.25F * quantile(sorted, 0.5));  // where the gain is low the samples are few counts
  for (std::size_t b = 0; b < ping.beamCount; ++b)
    for (std::size_t bin = 0; bin < ping.rangeCount; ++bin) {
      float& level = images.level.beam(b)[bin];
      level -= floors[bin];
      images.contrast.beam(b)[bin] = level / std::max(floors[bin], least);
    }
  subtractBeamFloor(images.level, firstBin);
  subtractBeamFloor(images.contrast, firstBin);
  return images;
}

/// Root mean square of the samples below the floor, where there is nothing but noise.
float noiseLevel(const Beams& image, std::size_t firstBin) {
  double sum = 0, count = 0;
  for (std::size_t b = 0; b < image.beams; b += 4)
    for (std::size_t bin = firstBin; bin < image.bins; ++bin)
      if (const float v = image.beam(b)[bin]; v < 0) {
        sum += static_cast<double>(v) * v;
        ++count;
      }
  return count > 0 ? static_cast<float>(std::sqrt(sum / count)) : 0.0F;
}

/// Mean of the neighbouring beams.
void averaged(const Beams& image, std::size_t beam, int count, std::vector<float>& profile) {
  const int half = count / 2;
  const auto last = static_cast<std::ptrdiff_t>(image.beams) - 1;
  const auto from = std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(beam) - half);
  const auto to = std::min<std::ptrdiff_t>(last, static_cast<std::ptrdiff_t>(beam) + half);
  profile.assign(image.bins, 0);
  for (auto b = from; b <= to; ++b) {
    const float* values = image.beam(static_cast<std::size_t>(b));
    for (std::size_t bin = 0; bin < image.bins; ++bin) profile[bin] += values[bin];
  }
  const float scale = 1.0F / static_cast<float>(to - from + 1);
  for (float& v : profile) v *= scale;
}

struct Band {
  std::size_t first = 0, last = 0;  ///< bins
  double excess = 0;                ///< in thresholds
};

/// The run of bins with the largest sum of clipped (sample - threshold).
Band largestRun(const std::vector<float>& profile, std::size_t firstBin, float threshold) {
  Band best;
  double sum = 0;
  std::size_t start = firstBin;
  for (std::size_t bin = firstBin; bin < profile.size(); ++bin) {
    const double x = std::clamp(profile[bin] / threshold, -1.0F, 4.0F) - 1.0;
    if (sum <= 0) {
      sum = 0;
      start = bin;
    }
    sum += x;
    if (sum > best.excess) best = {start, bin, sum};
  }
  return best;
}

/// Half the median level inside the bands of some beams.
float halfEchoLevel(const Beams& image, std::size_t firstBin, float threshold, const SwathOptions& options) {
  std::vector<float> inside, profile;
  for (std::size_t b = 0; b < image.beams; b += static_cast<std::size_t>(options.beamStep) * 2) {
    averaged(image, b, options.beamsAveraged, profile);
    const Band band = largestRun(profile, firstBin, threshold);
    if (band.excess >= options.minContrast)
      inside.insert(inside.end(), profile.begin() + static_cast<std::ptrdiff_t>(band.first),
                    profile.begin() + static_cast<std::ptrdiff_t>(band.last) + 1);
  }
  return inside.empty() ? threshold : 0.5F * quantile(inside, 0.5);
}

/// Best place for one step between two levels in the bins [from, to): the first bin of the farther level, by least
/// squares. On a ramp between two flat levels that is the ramp's middle.
std::size_t stepIn(const std::vector<double>& sums, std::size_t from, std::size_t to) {
  std::size_t best = from + (to - from) / 2;
  double most = -1;
  for (std::size_t k = from + 1; k < to; ++k) {
    const auto n1 = static_cast<double>(k - from), n2 = static_cast<double>(to - k);
    const double difference = (sums[to] - sums[k]) / n2 - (sums[k] - sums[from]) / n1;
    const double gain = n1 * n2 * difference * difference;
    if (gain > most) {
      most = gain;
      best = k;
    }
  }
  return best;
}

/// Moves an edge to the step between the levels on its own two sides, in a window around it that follows.
std::size_t refined(const std::vector<double>& sums, std::size_t edge, std::size_t firstBin, double window_bins) {
  for (int round = 0; round < 3; ++round) {
    const auto half = static_cast<std::size_t>(std::max(5.0, window_bins));
    const std::size_t last = sums.size() - 1;
    const std::size_t room = std::min({half, edge > firstBin ? edge - firstBin : 0, last - std::min(last, edge)});
    if (room < 4) return edge;
    edge = stepIn(sums, edge - room, edge + room);
  }
  return edge;
}

/// How many metres of range a radian of elevation is at either edge, on a level bed seen from `near_m` to `far_m` over
/// the aperture: r sin(depression) is the same at both, dr = r cot(depression) de.
std::pair<double, double> rangePerRadian(double near_m, double far_m, double aperture_rad) {
  const double steep = std::atan2(far_m * std::sin(aperture_rad), far_m * std::cos(aperture_rad) - near_m);
  const auto per = [](double range_m, double depression_rad) {
    const double cotangent = 1 / std::tan(std::clamp(depression_rad, 0.1, 1.5));
    return range_m * std::clamp(cotangent, 0.2, 4.0);
  };
  return {per(near_m, steep), per(far_m, steep - aperture_rad)};
}

double middleOf(const std::vector<float>& profile, const Band& band) {
  double sum = 0, weight = 0;
  for (std::size_t bin = band.first; bin <= band.last; ++bin) {
    const double w = std::pow(std::max(0.0F, profile[bin]), 2);
    sum += w * static_cast<double>(bin);
    weight += w;
  }
  return weight > 0 ? sum / weight : 0.5 * static_cast<double>(band.first + band.last);
}

/// Twice the band's median level: brighter samples are objects, not the bed.
float clipLevel(const std::vector<float>& profile, const Band& band) {
  std::vector<float> inside(profile.begin() + static_cast<std::ptrdiff_t>(band.first),
                            profile.begin() + static_cast<std::ptrdiff_t>(band.last) + 1);
  return 2 * quantile(inside, 0.5);
}

}  // namespace

std::vector<Swath> findSwaths(const obs::CObservationImagingSonar& ping, const SwathOptions& options) {
  if (ping.rangeCount == 0 || ping.beamCount == 0) return {};
  const double skip = std::max(0.0, (options.minRange_m - ping.rangeOffset_m) / ping.rangeResolution_m);
  const auto firstBin = static_cast<std::size_t>(skip);
  if (firstBin + 10 >= ping.rangeCount) return {};
  const Images images = withoutFloor(ping, firstBin, options.floorQuantile);
  const float noise = noiseLevel(images.contrast, firstBin);
  if (noise <= 0) return {};
  float threshold = 2 * noise;
  for (int round = 0; round < 2; ++round)
    threshold = std::max(1.5F * noise, halfEchoLevel(images.contrast, firstBin, threshold, options));

  std::vector<Swath> swaths;
  std::vector<float> profile;
  std::vector<double> sums;  // of the samples before each bin
  const auto edge_m = [&](std::size_t bin) {
    return ping.rangeOffset_m + static_cast<double>(bin) * ping.rangeResolution_m;
  };
  for (std::size_t b = 0; b < ping.beamCount; b += static_cast<std::size_t>(options.beamStep)) {
    averaged(images.contrast, b, options.beamsAveraged, profile);
    const Band band = largestRun(profile, firstBin, threshold);
    const double length_m = static_cast<double>(band.last - band.first + 1) * ping.rangeResolution_m;
    if (band.excess < options.minContrast || length_m < options.minLength_m) continue;

    averaged(images.level, b, options.beamsAveraged, profile);
    const float clip = clipLevel(profile, band);
    sums.assign(1, 0);
    for (const float v : profile) sums.push_back(sums.back() + std::min(v, clip));
    const auto [perNear, perFar] = rangePerRadian(edge_m(band.first), edge_m(band.last + 1), ping.verticalAperture_rad);
    const double window = options.edgeWindow_rad / ping.rangeResolution_m;
    const std::size_t near = refined(sums, band.first, firstBin, window * perNear);
    const std::size_t far = refined(sums, band.last + 1, firstBin, window * perFar);
    swaths.push_back({ping.bearings_rad[b], edge_m(near), edge_m(far),
                      ping.rangeOffset_m + (middleOf(profile, band) + 0.5) * ping.rangeResolution_m,
                      band.excess / static_cast<double>(band.last - band.first + 1)});
  }
  return swaths;
}

}  // namespace s2s::calib
