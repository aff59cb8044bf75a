#include "bed_picture.h"

#include <algorithm>
#include <cmath>

namespace s2s::calib {

namespace {

std::vector<float> kernelOf(double sigma_pixels) {
  const int reach = std::max(1, static_cast<int>(std::ceil(2.5 * sigma_pixels)));
  std::vector<float> kernel;
  for (int k = -reach; k <= reach; ++k)
    kernel.push_back(static_cast<float>(std::exp(-0.5 * std::pow(k / std::max(0.1, sigma_pixels), 2))));
  return kernel;
}

/// Gaussian blur along rows, then along columns, zero outside.
std::vector<float> blurred(const std::vector<float>& image, int width, int height, const std::vector<float>& kernel) {
  const int reach = static_cast<int>(kernel.size()) / 2;
  std::vector<float> half(image.size(), 0.0F), whole(image.size(), 0.0F);
  for (int y = 0; y < height; ++y)
    for (int k = -reach; k <= reach; ++k) {
      const float w = *(kernel.data() + k + reach);
      const int first = std::max(0, -k), end = std::min(width, width - k);
      const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * width;
      const float* from = image.data() + row + k;
      float* to = half.data() + row;
      for (int x = first; x < end; ++x) to[x] += w * from[x];
    }
  for (int k = -reach; k <= reach; ++k) {
    const float w = *(kernel.data() + k + reach);
    for (int y = std::max(0, -k); y < std::min(height, height - k); ++y) {
      const float* from = half.data() + static_cast<std::ptrdiff_t>(y + k) * width;
      float* to = whole.data() + static_cast<std::ptrdiff_t>(y) * width;
      for (int x = 0; x < width; ++x) to[x] += w * from[x];
    }
  }
  return whole;
}

/// Sums over a tile at one displacement.
struct Correlation {
  double product = 0, first2 = 0, second2 = 0, known = 0;
  double value() const { return first2 > 0 && second2 > 0 ? product / std::sqrt(first2 * second2) : 0; }
};

Correlation correlate(const BedPicture& a, const BedPicture& b, const PictureTile& tile, int dx, int dy) {
  Correlation sums;
  const int x0 = std::max({tile.x0, a.x0(), b.x0() - dx});
  const int x1 = std::min({tile.x0 + tile.size, a.x0() + a.width(), b.x0() + b.width() - dx});
  const int y0 = std::max({tile.y0, a.y0(), b.y0() - dy});
  const int y1 = std::min({tile.y0 + tile.size, a.y0() + a.height(), b.y0() + b.height() - dy});
  for (int y = y0; y < y1 && x0 < x1; ++y) {
    const float *va = a.values(y - a.y0()) + (x0 - a.x0()), *ka = a.known(y - a.y0()) + (x0 - a.x0());
    const float *vb = b.values(y + dy - b.y0()) + (x0 + dx - b.x0()),
                *kb = b.known(y + dy - b.y0()) + (x0 + dx - b.x0());
    float product = 0, a2 = 0, b2 = 0, known = 0;
    for (int k = 0; k < x1 - x0; ++k) {
      product += va[k] * vb[k];
      a2 += va[k] * va[k] * kb[k];
      b2 += vb[k] * vb[k] * ka[k];
      known += ka[k] * kb[k];
    }
    sums.product += product;
    sums.first2 += a2;
    sums.second2 += b2;
    sums.known += known;
  }
  return sums;
}

/// Place of a parabola's peak between its middle sample and its neighbours.
double peakOffset(double before, double peak, double after) {
  const double bend = before - 2 * peak + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

/// Centre of what both pictures know of a tile, in pixels.
Eigen::Vector2d centreOf(const BedPicture& a, const BedPicture& b, const PictureTile& tile, int dx, int dy) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0;
  const int x0 = std::max({tile.x0, a.x0(), b.x0() - dx});
  const int x1 = std::min({tile.x0 + tile.size, a.x0() + a.width(), b.x0() + b.width() - dx});
  const int y0 = std::max({tile.y0, a.y0(), b.y0() - dy});
  const int y1 = std::min({tile.y0 + tile.size, a.y0() + a.height(), b.y0() + b.height() - dy});
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      if (a.known(y - a.y0())[x - a.x0()] * b.known(y + dy - b.y0())[x + dx - b.x0()] == 0) continue;
      sum += Eigen::Vector2d(x + 0.5, y + 0.5);
      ++count;
    }
  return sum / std::max(1.0, count);
}

}  // namespace

void BedPicture::make(const std::vector<Sample>& samples, const TextureOptions& options) {
  values_.clear();
  if (samples.empty()) return;
  const auto index = [this](float v_m) { return static_cast<int>(std::floor(v_m / pixel_m_)); };
  int x1 = index(samples[0].x_m), y1 = index(samples[0].y_m);
  x0_ = x1, y0_ = y1;
  for (const Sample& s : samples) {
    x0_ = std::min(x0_, index(s.x_m)), x1 = std::max(x1, index(s.x_m));
    y0_ = std::min(y0_, index(s.y_m)), y1 = std::max(y1, index(s.y_m));
  }
  width_ = x1 - x0_ + 1, height_ = y1 - y0_ + 1;
  const auto size = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  std::vector<float> sum(size, 0.0F), count(size, 0.0F);
  for (const Sample& s : samples) {
    const auto at = static_cast<std::size_t>(index(s.y_m) - y0_) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(index(s.x_m) - x0_);
    sum[at] += s.contrast;
    count[at] += 1;
  }
  const auto fine = kernelOf(options.fineBlur_m / pixel_m_), coarse = kernelOf(options.coarseBlur_m / pixel_m_);
  const auto fineSum = blurred(sum, width_, height_, fine), fineCount = blurred(count, width_, height_, fine);
  const auto coarseSum = blurred(sum, width_, height_, coarse), coarseCount = blurred(count, width_, height_, coarse);
  values_.assign(size, 0.0F);
  known_.assign(size, 0.0F);
  for (std::size_t k = 0; k < size; ++k) {
    if (fineCount[k] < 1.5F) continue;
    values_[k] = fineSum[k] / fineCount[k] - coarseSum[k] / coarseCount[k];
    known_[k] = 1;
  }
}

double knownShare(const BedPicture& picture, const PictureTile& tile) {
  double known = 0;
  const int x0 = std::max(tile.x0, picture.x0()), x1 = std::min(tile.x0 + tile.size, picture.x0() + picture.width());
  const int y0 = std::max(tile.y0, picture.y0()), y1 = std::min(tile.y0 + tile.size, picture.y0() + picture.height());
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) known += picture.known(y - picture.y0())[x - picture.x0()];
  return known / (static_cast<double>(tile.size) * tile.size);
}

std::optional<PictureMatch> matchPictures(const BedPicture& first, const BedPicture& second, const PictureTile& tile,
                                          double reach_m, const TextureOptions& options) {
  const int reach = std::max(2, static_cast<int>(std::lround(reach_m / first.pixel_m()))), side = 2 * reach + 1;
  const double least = options.minOverlap * tile.size * tile.size;
  std::vector<double> map(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0);
  const auto at = [&](int dx, int dy) -> double& {
    return *(map.data() + static_cast<std::ptrdiff_t>(dy + reach) * side + dx + reach);
  };
  int bestX = 0, bestY = 0;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const Correlation sums = correlate(first, second, tile, dx, dy);
      at(dx, dy) = sums.known >= least ? sums.value() : 0;
      if (at(dx, dy) > at(bestX, bestY)) bestX = dx, bestY = dy;
    }
  PictureMatch match;
  match.correlation = at(bestX, bestY);
  if (match.correlation <= 0 || std::abs(bestX) == reach || std::abs(bestY) == reach) return {};
  const int lobe = static_cast<int>(std::lround(1.2 * options.coarseBlur_m / first.pixel_m()));
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx)
      if (std::hypot(dx - bestX, dy - bestY) > lobe) match.next = std::max(match.next, at(dx, dy));
  match.displacement_m =
      first.pixel_m() *
      Eigen::Vector2d(bestX + peakOffset(at(bestX - 1, bestY), match.correlation, at(bestX + 1, bestY)),
                      bestY + peakOffset(at(bestX, bestY - 1), match.correlation, at(bestX, bestY + 1)));
  match.centre_m = first.pixel_m() * centreOf(first, second, tile, bestX, bestY);
  return match;
}

}  // namespace s2s::calib
