#include "ping_view.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "s2s/sonar/cartesian.h"

namespace s2s::inspect {

namespace {

constexpr int kCartesianHeight = 900;
constexpr int kPolarHeight = 900;
constexpr double kDeg = M_PI / 180.0;

const cv::Scalar kGridColor(90, 90, 60);
const cv::Scalar kTextColor(220, 220, 220);

cv::Mat to8Bit(const cv::Mat& image) {
  if (image.depth() == CV_8U) return image;
  double maximum = 0;
  cv::minMaxIdx(image, nullptr, &maximum);
  cv::Mat out;
  image.convertTo(out, CV_8U, maximum > 0 ? 255.0 / maximum : 1.0);
  return out;
}

cv::Mat colored(const cv::Mat& gray) {
  cv::Mat picture;
  cv::applyColorMap(gray, picture, cv::COLORMAP_BONE);
  return picture;
}

void drawText(cv::Mat& picture, const std::string& text, const cv::Point& at) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.4, kTextColor, 1, cv::LINE_AA);
}

cv::Point rounded(const Eigen::Vector2d& rowColumn) {
  return {static_cast<int>(std::lround(rowColumn.y())), static_cast<int>(std::lround(rowColumn.x()))};
}

/// 1, 2 or 5 times a power of ten that gives four to ten rings.
double ringStep_m(double maxRange_m) {
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(1e-3, maxRange_m / 4))));
  const double share = maxRange_m / 4 / decade;
  return decade * (share >= 5 ? 5 : share >= 2 ? 2 : 1);
}

void drawGrid(cv::Mat& picture, const sonar::PingGeometry& geometry, const sonar::CartesianGrid& grid) {
  const auto at = [&](double range_m, double bearing_rad) {
    return rounded(grid.pixelOf({range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad)}));
  };
  const double low = geometry.minBearing_rad(), high = geometry.maxBearing_rad();
  const double step_m = ringStep_m(geometry.maxRange_m());
  const auto rings = static_cast<int>(std::floor(geometry.maxRange_m() / step_m + 1e-6));
  const auto pieces = static_cast<int>(std::ceil((high - low) / kDeg));
  for (int ring = 1; ring <= rings; ++ring) {
    const double range_m = ring * step_m;
    for (int piece = 0; piece < pieces; ++piece) {
      const double b = low + piece * kDeg;
      cv::line(picture, at(range_m, b), at(range_m, std::min(b + kDeg, high)), kGridColor, 1, cv::LINE_AA);
    }
    drawText(picture, cv::format("%g m", range_m), at(range_m, high) + cv::Point(3, 12));
  }
  for (auto i = std::lround(std::ceil(low / (15 * kDeg))); 15 * kDeg * static_cast<double>(i) <= high; ++i) {
    const double b = 15 * kDeg * static_cast<double>(i);
    cv::line(picture, at(0, b), at(geometry.maxRange_m(), b), kGridColor, 1, cv::LINE_AA);
    drawText(picture, cv::format("%+.0f", b / kDeg + 0.0), at(0.97 * geometry.maxRange_m(), b));
  }
}

}  // namespace

PingView polarView(const cv::Mat& image, const sonar::PingGeometry& geometry) {
  cv::Mat gray = to8Bit(image).clone();
  const bool rising = geometry.bearings_rad.size() > 1 && geometry.bearings_rad.front() < geometry.bearings_rad.back();
  cv::flip(gray, gray, 0);
  if (rising) cv::flip(gray, gray, 1);
  const int width = std::max(512, image.cols);
  cv::resize(gray, gray, {width, kPolarHeight}, 0, 0, cv::INTER_AREA);
  PingView view;
  view.picture = colored(gray);
  const double sx = static_cast<double>(width) / image.cols, sy = static_cast<double>(kPolarHeight) / image.rows;
  const int rows = image.rows, columns = image.cols;
  view.toPixel = [=](double bin, double beam) {
    const double column = rising ? columns - 1 - beam : beam;
    return cv::Point2d((column + 0.5) * sx - 0.5, (rows - bin - 0.5) * sy - 0.5);
  };
  return view;
}

PingView cartesianView(const cv::Mat& image, const sonar::PingGeometry& geometry) {
  auto grid = sonar::gridFor(geometry, 1.0);
  grid.resolution_m = (grid.maxX_m - grid.minX_m) / kCartesianHeight;
  PingView view;
  view.picture = colored(sonar::toCartesian(to8Bit(image), geometry, grid));
  drawGrid(view.picture, geometry, grid);
  view.toPixel = [geometry, grid](double bin, double beam) {
    const Eigen::Vector2d pixel = grid.pixelOf(sonar::planePoint(geometry, bin, beam).head<2>());
    return cv::Point2d(pixel.y(), pixel.x());
  };
  return view;
}

cv::Scalar colorOf(int index) {
  // Hues by the golden angle: neighbours in number are far apart in colour.
  const cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar((index * 111) % 180, 220, 255));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  const auto& pixel = bgr.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(pixel[0]), static_cast<double>(pixel[1]), static_cast<double>(pixel[2])};
}

void drawDot(PingView& view, double bin, double beam, const cv::Scalar& color, int radius) {
  const cv::Point2d p = view.toPixel(bin, beam);
  cv::circle(view.picture, {static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y))}, radius, color,
             cv::FILLED, cv::LINE_8);
}

void drawTitle(cv::Mat& picture, const std::string& text) {
  cv::putText(picture, text, {10, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {0, 0, 0}, 3, cv::LINE_AA);
  cv::putText(picture, text, {10, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {255, 255, 255}, 1, cv::LINE_AA);
}

cv::Mat sideBySide(const cv::Mat& left, const cv::Mat& right) {
  const int height = std::max(left.rows, right.rows);
  cv::Mat out(height, left.cols + right.cols + 10, CV_8UC3, cv::Scalar(60, 60, 60));
  left.copyTo(out(cv::Rect(0, height - left.rows, left.cols, left.rows)));
  right.copyTo(out(cv::Rect(left.cols + 10, height - right.rows, right.cols, right.rows)));
  return out;
}

}  // namespace s2s::inspect
