#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "s2s/eval/object_presence.h"
#include "s2s/products/ply_reader.h"

namespace s2s::eval {

/// Height above the bare seabed [m] of a place in the world; NaN where there is none.
using HeightFunction = std::function<double(const Eigen::Vector3d&)>;

/// Colours for heights from 0 to `top_m`.
class HeightColours {
 public:
  explicit HeightColours(double top_m);
  cv::Vec3b at(double height_m) const;
  /// A strip with the scale and its ends.
  cv::Mat legend(int width_px) const;

 private:
  double top_m_;
  cv::Mat table_;
};

/// A parallel projection of an object's surroundings onto two axes of the world.
class ObjectView {
 public:
  /// @param towards points from the picture to the eye: what is nearer hides what is behind
  ObjectView(const products::PlyMesh& surface, const Eigen::Vector3d& right, const Eigen::Vector3d& up,
             const Eigen::Vector3d& towards, double margin_m);
  ObjectView(const ObjectView& other);
  ObjectView& operator=(const ObjectView&) = delete;

  void drawPoints(std::vector<ObjectPoint> points, const HeightFunction& height, const HeightColours& colours);
  void drawSurface(const products::PlyMesh& surface, const HeightFunction& height, const HeightColours& colours);
  /// The silhouette.
  void drawOutline(const products::PlyMesh& surface);
  /// The picture with a title and a bar that shows the scale.
  const cv::Mat& finish(const std::string& title);

 private:
  cv::Point pixel(const Eigen::Vector3d& p) const;

  Eigen::Vector3d right_, up_, towards_;
  Eigen::AlignedBox2d box_;
  double scale_ = 1, nearest_ = 0, farthest_ = 0;
  cv::Mat picture_;
};

}  // namespace s2s::eval
