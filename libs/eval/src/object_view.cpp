#include "object_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace s2s::eval {

namespace {

constexpr int kWidth_px = 480, kText_px = 24, kLegend_px = 28;
constexpr double kPoint_m = 0.015;    // side of a point's square
constexpr double kLeastAspect = 0.4;  // height over width: long objects are seen with the bed beside them
const cv::Scalar kBackground(40, 30, 20), kWhite(255, 255, 255);

void write(cv::Mat& picture, const std::string& text, cv::Point at) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, kWhite, 1, cv::LINE_AA);
}

/// Corners of a triangle.
std::array<Eigen::Vector3d, 3> cornersOf(const products::PlyMesh& surface,
                                         const std::array<std::uint32_t, 3>& triangle) {
  return {surface.vertices[triangle[0]], surface.vertices[triangle[1]], surface.vertices[triangle[2]]};
}

}  // namespace

HeightColours::HeightColours(double top_m) : top_m_(top_m) {
  cv::Mat ramp(1, 256, CV_8UC1);
  for (int i = 0; i < 256; ++i) ramp.at<std::uint8_t>(0, i) = static_cast<std::uint8_t>(i);
  cv::applyColorMap(ramp, table_, cv::COLORMAP_TURBO);
}

cv::Vec3b HeightColours::at(double height_m) const {
  // The ends of the ramp are too dark to be seen on the background.
  const double share = std::isfinite(height_m) ? std::clamp(height_m / top_m_, 0.0, 1.0) : 0.0;
  return table_.at<cv::Vec3b>(0, 20 + static_cast<int>(std::lround(share * 220)));
}

cv::Mat HeightColours::legend(int width_px) const {
  cv::Mat strip(kLegend_px, width_px, CV_8UC3, cv::Scalar::all(0));
  char top[64];
  std::snprintf(top, sizeof top, "%.2f m above the seabed", top_m_);
  const int begin = 40, end = width_px / 2;
  for (int x = begin; x < end; ++x)
    cv::line(strip, {x, 8}, {x, kLegend_px - 8}, cv::Scalar(at(top_m_ * (x - begin) / (end - begin))));
  write(strip, "0", {begin - 16, 19});
  write(strip, top, {end + 8, 19});
  return strip;
}

ObjectView::ObjectView(const products::PlyMesh& surface, const Eigen::Vector3d& right, const Eigen::Vector3d& up,
                       const Eigen::Vector3d& towards, double margin_m)
    : right_(right), up_(up), towards_(towards) {
  farthest_ = std::numeric_limits<double>::infinity();
  nearest_ = -farthest_;
  for (const auto& triangle : surface.triangles)
    for (const auto& v : cornersOf(surface, triangle)) {
      box_.extend(Eigen::Vector2d(right.dot(v), up.dot(v)));
      nearest_ = std::max(nearest_, towards.dot(v) + margin_m);
      farthest_ = std::min(farthest_, towards.dot(v) - margin_m);
    }
  box_.min().array() -= margin_m;
  box_.max().array() += margin_m;
  const double missing_m = kLeastAspect * box_.sizes().x() - box_.sizes().y();
  if (missing_m > 0) {
    box_.min().y() -= 0.5 * missing_m;
    box_.max().y() += 0.5 * missing_m;
  }
  scale_ = kWidth_px / box_.sizes().x();
  picture_ = cv::Mat(std::clamp(static_cast<int>(scale_ * box_.sizes().y()), 40, 900) + kText_px, kWidth_px, CV_8UC3,
                     kBackground);
}

ObjectView::ObjectView(const ObjectView& other)
    : right_(other.right_),
      up_(other.up_),
      towards_(other.towards_),
      box_(other.box_),
      scale_(other.scale_),
      nearest_(other.nearest_),
      farthest_(other.farthest_),
      picture_(other.picture_.clone()) {}

cv::Point ObjectView::pixel(const Eigen::Vector3d& p) const {
  return {static_cast<int>(scale_ * (right_.dot(p) - box_.min().x())),
          kText_px + static_cast<int>(scale_ * (box_.max().y() - up_.dot(p)))};
}

void ObjectView::drawPoints(std::vector<ObjectPoint> points, const HeightFunction& height,
                            const HeightColours& colours) {
  std::sort(points.begin(), points.end(), [this](const ObjectPoint& a, const ObjectPoint& b) {
    return towards_.dot(a.p_world) < towards_.dot(b.p_world);
  });
  const int side_px = std::max(2, static_cast<int>(std::lround(kPoint_m * scale_)));
  for (const auto& point : points) {
    const double depth = towards_.dot(point.p_world);
    if (depth > nearest_ || depth < farthest_) continue;
    const cv::Point at = pixel(point.p_world);
    cv::rectangle(picture_, {at.x - side_px / 2, at.y - side_px / 2, side_px, side_px},
                  cv::Scalar(colours.at(height(point.p_world))), cv::FILLED);
  }
}

void ObjectView::drawSurface(const products::PlyMesh& surface, const HeightFunction& height,
                             const HeightColours& colours) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto corners = cornersOf(surface, surface.triangles[i]);
    order.emplace_back(towards_.dot(corners[0] + corners[1] + corners[2]), i);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [depth, i] : order) {
    const auto corners = cornersOf(surface, surface.triangles[i]);
    const std::vector<cv::Point> polygon = {pixel(corners[0]), pixel(corners[1]), pixel(corners[2])};
    const Eigen::Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3;
    cv::fillConvexPoly(picture_, polygon, cv::Scalar(colours.at(height(middle))));
  }
}

void ObjectView::drawOutline(const products::PlyMesh& surface) {
  cv::Mat mask = cv::Mat::zeros(picture_.size(), CV_8UC1);
  for (const auto& triangle : surface.triangles) {
    const auto corners = cornersOf(surface, triangle);
    cv::fillConvexPoly(mask, std::vector<cv::Point>{pixel(corners[0]), pixel(corners[1]), pixel(corners[2])},
                       cv::Scalar(255));
  }
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  cv::drawContours(picture_, outlines, -1, kWhite, 1, cv::LINE_AA);
}

const cv::Mat& ObjectView::finish(const std::string& title) {
  cv::rectangle(picture_, {0, 0, kWidth_px, kText_px}, cv::Scalar::all(0), cv::FILLED);
  write(picture_, title, {6, 17});
  const double bar_m = box_.sizes().x() > 2.5 ? 1.0 : 0.5;
  const int y = picture_.rows - 8, x = 10, end = x + static_cast<int>(std::lround(bar_m * scale_));
  cv::rectangle(picture_, {x - 4, y - 20, end - x + 8, 26}, cv::Scalar::all(0), cv::FILLED);
  cv::line(picture_, {x, y}, {end, y}, kWhite, 2);
  write(picture_, bar_m == 1.0 ? "1 m" : "0.5 m", {x, y - 6});
  cv::rectangle(picture_, {0, 0, picture_.cols, picture_.rows}, cv::Scalar(90, 90, 90), 1);
  return picture_;
}

}  // namespace s2s::eval
