#include "s2s/eval/object_pictures.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"

namespace s2s::eval {

namespace {

constexpr int kWidth_px = 640, kText_px = 24;
constexpr double kMargin_m = 0.35;

cv::Scalar colourOf(map::Layer layer) {
  if (layer == map::Layer::LineHorizontal) return {90, 220, 90};
  if (layer == map::Layer::LineVertical) return {60, 150, 255};
  return {255, 255, 255};
}

/// A parallel projection onto two axes of the world.
class View {
 public:
  View(const products::PlyMesh& surface, const Eigen::Vector3d& right, const Eigen::Vector3d& up)
      : right_(right), up_(up) {
    for (const auto& v : surface.vertices) box_.extend(Eigen::Vector2d(right.dot(v), up.dot(v)));
    box_.min().array() -= kMargin_m;
    box_.max().array() += kMargin_m;
    scale_ = kWidth_px / box_.sizes().x();
    picture_ = cv::Mat(std::clamp(static_cast<int>(scale_ * box_.sizes().y()), 40, 900) + kText_px, kWidth_px, CV_8UC3,
                       cv::Scalar(40, 30, 20));
  }

  void drawSurface(const products::PlyMesh& surface) {
    for (const auto& [a, b, c] : surface.triangles) {
      line(surface.vertices[a], surface.vertices[b]);
      line(surface.vertices[b], surface.vertices[c]);
      line(surface.vertices[c], surface.vertices[a]);
    }
  }
  void drawPoints(const std::vector<ObjectPoint>& points) {
    for (const auto& point : points) {
      const cv::Point at = pixel(point.p_world);
      if (at.y < kText_px || !cv::Rect(0, 0, picture_.cols, picture_.rows).contains(at)) continue;
      picture_.at<cv::Vec3b>(at) = cv::Vec3b(static_cast<std::uint8_t>(colourOf(point.layer)[0]),
                                             static_cast<std::uint8_t>(colourOf(point.layer)[1]),
                                             static_cast<std::uint8_t>(colourOf(point.layer)[2]));
    }
  }
  const cv::Mat& finish(const std::string& title) {
    char text[160];
    std::snprintf(text, sizeof text, "%s, %.1f m wide", title.c_str(), box_.sizes().x());
    cv::rectangle(picture_, {0, 0, kWidth_px, kText_px}, cv::Scalar(0, 0, 0), cv::FILLED);
    cv::putText(picture_, text, {6, 17}, cv::FONT_HERSHEY_SIMPLEX, 0.5, cv::Scalar(255, 255, 255), 1, cv::LINE_AA);
    return picture_;
  }

 private:
  cv::Point pixel(const Eigen::Vector3d& p) const {
    return {static_cast<int>(scale_ * (right_.dot(p) - box_.min().x())),
            kText_px + static_cast<int>(scale_ * (box_.max().y() - up_.dot(p)))};
  }
  void line(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    cv::line(picture_, pixel(a), pixel(b), cv::Scalar(110, 100, 90), 1);
  }

  Eigen::Vector3d right_, up_;
  Eigen::AlignedBox2d box_;
  double scale_ = 1;
  cv::Mat picture_;
};

cv::Mat drawn(View view, const products::PlyMesh& surface, const std::vector<ObjectPoint>& points,
              const std::string& title) {
  view.drawSurface(surface);
  view.drawPoints(points);
  return view.finish(title);
}

/// The object's longer horizontal axis.
Eigen::Vector3d longAxis(const products::PlyMesh& surface) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& v : surface.vertices) mean += v.head<2>();
  mean /= static_cast<double>(surface.vertices.size());
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (const auto& v : surface.vertices) moments += (v.head<2>() - mean) * (v.head<2>() - mean).transpose();
  const double yaw_rad = 0.5 * std::atan2(2 * moments(0, 1), moments(0, 0) - moments(1, 1));
  return {std::cos(yaw_rad), std::sin(yaw_rad), 0};
}

}  // namespace

void writeObjectPictures(const ObjectFinder& finder, const std::string& folder) {
  const auto presence = finder.presence();
  for (std::size_t i = 0; i < presence.size(); ++i) {
    const auto& points = finder.pointsOf(i);
    if (points.empty()) continue;
    const auto& surface = finder.surfaceOf(i);
    const Eigen::Vector3d right = longAxis(surface), up = Eigen::Vector3d::UnitZ();
    cv::Mat picture;
    cv::vconcat(drawn(View(surface, right, up.cross(right)), surface, points, presence[i].name + " from above"),
                drawn(View(surface, right, up), surface, points, presence[i].name + " from the side"), picture);
    std::vector<std::uint8_t> bytes;
    cv::imencode(".png", picture, bytes);
    core::writeTextFile((std::filesystem::path(folder) / ("object_" + presence[i].name + ".png")).string(),
                        std::string(bytes.begin(), bytes.end()));
  }
}

}  // namespace s2s::eval
