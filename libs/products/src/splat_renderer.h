#pragma once

#include <Eigen/Core>
#include <limits>
#include <opencv2/core.hpp>
#include <vector>

#include "s2s/products/colour_ramp.h"

namespace s2s::products {

/// A parallel projection onto a picture: no perspective, so that one scale bar holds everywhere.
struct ParallelView {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< drawn in the picture's middle
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< rows: to the right, up, towards the viewer
  double pxPerMetreX = 1, pxPerMetreY = 1;
  int width_px = 0, height_px = 0;

  /// x and y in pixels (y down), z growing away from the viewer in metres.
  Eigen::Vector3d project(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d q = axes * (p - centre_m);
    return {0.5 * width_px + pxPerMetreX * q.x(), 0.5 * height_px - pxPerMetreY * q.y(), -q.z()};
  }

  /// Chooses centre and scale such that all `corners` are seen with `border_px` around them. With `stretchY` above 1
  /// the vertical scale may be larger than the horizontal, up to that factor.
  /// `height_px` is the room there is; what is not needed of it is given up.
  void fit(const std::vector<Eigen::Vector3d>& corners, int border_px, double stretchY = 1);
};

/// Draws points as small squares with a depth buffer, in software: the same picture on every machine, and neither a
/// display nor a graphics driver is needed. It draws twice as large as asked for; `image` shades edges by the depth
/// steps around them (eye-dome lighting), closes pinholes and scales down, which smooths.
class SplatRenderer {
 public:
  enum class Shading { None, EyeDome };

  SplatRenderer(const ParallelView& view, Rgb background, Shading shading);

  const ParallelView& view() const { return view_; }
  /// @param size_m edge of the square; at least a pixel is drawn
  void add(const Eigen::Vector3d& p, Rgb colour, double size_m);

  /// BGR, 8 bit.
  cv::Mat image() const;

 private:
  struct Pixel {
    float depth_m = std::numeric_limits<float>::infinity();
    Rgb colour{};
  };
  using Pixels = std::vector<Pixel>;

  Pixels withoutPinholes() const;
  double brightness(const Pixels& pixels, int x, int y) const;
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < fine_.width_px && y < fine_.height_px; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(fine_.width_px) + static_cast<std::size_t>(x);
  }

  ParallelView view_, fine_;
  Rgb background_;
  Shading shading_;
  Pixels pixels_;
};

}  // namespace s2s::products
