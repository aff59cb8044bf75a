#include "splat_renderer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace s2s::products {

namespace {

constexpr int kOversampling = 2;
constexpr int kLargestSplat_px = 9;
constexpr int kPinholeNeighbours = 5;  // of eight
constexpr int kShadingReach_px = 2;
constexpr double kShadingStrength = 0.8;
constexpr double kDarkest = 0.3;

constexpr std::array<std::array<int, 2>, 8> kAround = {
    {{{-1, -1}}, {{0, -1}}, {{1, -1}}, {{-1, 0}}, {{1, 0}}, {{-1, 1}}, {{0, 1}}, {{1, 1}}}};

}  // namespace

void ParallelView::fit(const std::vector<Eigen::Vector3d>& corners, int border_px, double stretchY) {
  constexpr double kHuge = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kHuge), high = -low;
  for (const auto& corner : corners) {
    low = low.cwiseMin(axes * corner);
    high = high.cwiseMax(axes * corner);
  }
  const Eigen::Vector3d size = (high - low).cwiseMax(0.5);  // half a metre when there is nothing to see
  const double scaleX = (width_px - 2 * border_px) / size.x(), scaleY = (height_px - 2 * border_px) / size.y();
  pxPerMetreX = std::min(scaleX, scaleY);
  pxPerMetreY = std::clamp(scaleY, pxPerMetreX, pxPerMetreX * stretchY);
  height_px = std::min(height_px, static_cast<int>(std::ceil(size.y() * pxPerMetreY)) + 2 * border_px);
  centre_m = axes.transpose() * (0.5 * (low + high));
}

SplatRenderer::SplatRenderer(const ParallelView& view, Rgb background, Shading shading)
    : view_(view), fine_(view), background_(background), shading_(shading) {
  fine_.width_px *= kOversampling;
  fine_.height_px *= kOversampling;
  fine_.pxPerMetreX *= kOversampling;
  fine_.pxPerMetreY *= kOversampling;
  pixels_.resize(index(0, fine_.height_px));
}

void SplatRenderer::add(const Eigen::Vector3d& p, Rgb colour, double size_m) {
  const Eigen::Vector3d q = fine_.project(p);
  if (!(q.x() > -kLargestSplat_px && q.y() > -kLargestSplat_px && q.x() < fine_.width_px + kLargestSplat_px &&
        q.y() < fine_.height_px + kLargestSplat_px))
    return;
  const int size = std::clamp(static_cast<int>(std::lround(size_m * fine_.pxPerMetreX)), 1, kLargestSplat_px);
  const int left = static_cast<int>(std::floor(q.x() - 0.5 * (size - 1)));
  const int top = static_cast<int>(std::floor(q.y() - 0.5 * (size - 1)));
  const auto depth_m = static_cast<float>(q.z());
  for (int y = std::max(top, 0); y < std::min(top + size, fine_.height_px); ++y)
    for (int x = std::max(left, 0); x < std::min(left + size, fine_.width_px); ++x) {
      Pixel& pixel = pixels_[index(x, y)];
      if (depth_m < pixel.depth_m) pixel = {depth_m, colour};
    }
}

SplatRenderer::Pixels SplatRenderer::withoutPinholes() const {
  Pixels out = pixels_;
  for (int y = 0; y < fine_.height_px; ++y)
    for (int x = 0; x < fine_.width_px; ++x) {
      if (!std::isinf(pixels_[index(x, y)].depth_m)) continue;
      int filled = 0;
      Pixel nearest;
      for (const auto& [dx, dy] : kAround) {
        if (!inside(x + dx, y + dy)) continue;
        const Pixel& pixel = pixels_[index(x + dx, y + dy)];
        if (std::isinf(pixel.depth_m)) continue;
        ++filled;
        if (pixel.depth_m < nearest.depth_m) nearest = pixel;
      }
      if (filled >= kPinholeNeighbours) out[index(x, y)] = nearest;
    }
  return out;
}

double SplatRenderer::brightness(const Pixels& pixels, int x, int y) const {
  if (shading_ == Shading::None) return 1;
  const float here_m = pixels[index(x, y)].depth_m;
  double sum = 0;
  for (const auto& [dx, dy] : kAround) {
    const int nx = x + kShadingReach_px * dx, ny = y + kShadingReach_px * dy;
    if (!inside(nx, ny)) continue;
    const float there_m = pixels[index(nx, ny)].depth_m;
    if (std::isinf(there_m)) continue;
    // How steeply the surface falls away behind the neighbour, as rise over run; one and more counts as an edge.
    const double slope = (here_m - there_m) * fine_.pxPerMetreX / (3.0 * kShadingReach_px);
    sum += std::clamp(slope, 0.0, 1.0);
  }
  return std::max(kDarkest, 1 - kShadingStrength * sum / 4);
}

cv::Mat SplatRenderer::image() const {
  const Pixels pixels = withoutPinholes();
  cv::Mat fine(fine_.height_px, fine_.width_px, CV_8UC3, cv::Scalar(background_[2], background_[1], background_[0]));
  for (int y = 0; y < fine_.height_px; ++y)
    for (int x = 0; x < fine_.width_px; ++x) {
      const Pixel& pixel = pixels[index(x, y)];
      if (std::isinf(pixel.depth_m)) continue;
      const double light = brightness(pixels, x, y);
      auto& out = fine.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        out[c] = static_cast<std::uint8_t>(std::lround(light * pixel.colour[static_cast<std::size_t>(2 - c)]));
    }
  cv::Mat out;
  cv::resize(fine, out, cv::Size(view_.width_px, view_.height_px), 0, 0, cv::INTER_AREA);
  return out;
}

}  // namespace s2s::products
