#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "s2s/calib/texture.h"

namespace s2s::calib {

/// A picture of the bed in the map's frame: contrast, and how much of each pixel is known.
class BedPicture {
 public:
  explicit BedPicture(double pixel_m = 0.04) : pixel_m_(pixel_m) {}

  bool empty() const { return values_.empty(); }
  int width() const { return width_; }
  int height() const { return height_; }
  double pixel_m() const { return pixel_m_; }
  /// Indices of the lower corner, in pixels of the map.
  int x0() const { return x0_; }
  int y0() const { return y0_; }
  const float* values(int row) const { return values_.data() + static_cast<std::ptrdiff_t>(row) * width_; }
  /// 1 where the picture is known, else 0 (and so is the value).
  const float* known(int row) const { return known_.data() + static_cast<std::ptrdiff_t>(row) * width_; }

  struct Sample {
    float x_m, y_m, contrast;
  };
  /// Makes the picture of samples: mean in each pixel, freed of what is finer and coarser than the bed's texture.
  void make(const std::vector<Sample>& samples, const TextureOptions& options);

 private:
  double pixel_m_;
  int x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;
  std::vector<float> values_, known_;
};

/// A square of the map, in pixels.
struct PictureTile {
  int x0 = 0, y0 = 0, size = 0;
};

/// Share of a tile that a picture knows.
double knownShare(const BedPicture& picture, const PictureTile& tile);

/// How two pictures of the same tile are displaced.
struct PictureMatch {
  Eigen::Vector2d displacement_m = Eigen::Vector2d::Zero();  ///< what is at p in the first is at p + this in the second
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();        ///< of what both know, in the first
  double correlation = 0;                                    ///< at the peak
  double next = 0;                                           ///< best correlation away from it
};

/// By the peak of the normalised correlation, refined by a parabola. Nothing if the peak lies on the window's border or
/// too little of the tile is known to both.
std::optional<PictureMatch> matchPictures(const BedPicture& first, const BedPicture& second, const PictureTile& tile,
                                          double reach_m, const TextureOptions& options);

}  // namespace s2s::calib
