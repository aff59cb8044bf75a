#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "picture_drawing.h"
#include "s2s/products/map_pictures.h"

namespace s2s::products {

namespace {

constexpr int kLeft_px = 70, kTop_px = 36, kRight_px = 24, kBottom_px = 110;

/// Light from the north-west on a Lambert surface; a level seabed has brightness 1.
double relief(const HeightGrid& grid, int column, int row) {
  constexpr double kExaggeration = 2;
  const Eigen::Vector3d light = Eigen::Vector3d(-1, 1, 1.6).normalized();
  const auto height = [&](int c, int r) -> double {
    if (!grid.inside(c, r) || !grid.hasValue(c, r)) return grid.height_m[grid.index(column, row)];
    return grid.height_m[grid.index(c, r)];
  };
  const double scale = kExaggeration / (2 * grid.cell_m);
  const Eigen::Vector3d normal = Eigen::Vector3d(-scale * (height(column + 1, row) - height(column - 1, row)),
                                                 -scale * (height(column, row + 1) - height(column, row - 1)), 1)
                                     .normalized();
  return std::clamp(normal.dot(light) / light.z(), 0.45, 1.25);
}

ColourRamp depthRamp(const HeightGrid& grid, double datum_m) {
  std::vector<float> heights;
  for (const float h : grid.height_m)
    if (!std::isnan(h)) heights.push_back(h);
  if (heights.empty()) return MapColours(0, 1, datum_m - 1, datum_m).sonar;
  std::sort(heights.begin(), heights.end());
  const auto at = [&](double u) {
    return heights[static_cast<std::size_t>(u * static_cast<double>(heights.size() - 1))];
  };
  return MapColours(0, 1, at(0.01), at(0.99)).sonar;
}

struct GridPlace {
  double pxPerMetre = 1;
  int left = kLeft_px, bottom = 0;
  double west_m = 0, south_m = 0;

  int x(double metres) const { return left + static_cast<int>(std::lround((metres - west_m) * pxPerMetre)); }
  int y(double metres) const { return bottom - static_cast<int>(std::lround((metres - south_m) * pxPerMetre)); }
};

void drawAxes(cv::Mat& image, const HeightGrid& grid, const GridPlace& place) {
  const double east = grid.west_m + grid.columns * grid.cell_m, north = grid.south_m + grid.rows * grid.cell_m;
  const double step_m = roundStep(110 / place.pxPerMetre);
  for (const double x : ticks(grid.west_m, east, step_m)) {
    cv::line(image, {place.x(x), place.y(north)}, {place.x(x), place.bottom}, toBgr(kFaint), 1);
    drawText(image, stepText(x, step_m), place.x(x), place.bottom + 20, Align::Centre);
  }
  for (const double y : ticks(grid.south_m, north, step_m)) {
    cv::line(image, {place.left, place.y(y)}, {place.x(east), place.y(y)}, toBgr(kFaint), 1);
    drawText(image, stepText(y, step_m), place.left - 8, place.y(y) + 5, Align::Right);
  }
  drawText(image, "x [m]", place.x(east), place.bottom + 40, Align::Right);
  drawText(image, "y [m]", place.left - 8, place.y(north) - 16, Align::Right);
}

}  // namespace

cv::Mat drawGrid(const HeightGrid& grid, const HeightDatum& datum, int width_px, int height_px) {
  GridPlace place;
  const int columns = std::max(grid.columns, 1), rows = std::max(grid.rows, 1);
  place.pxPerMetre = std::min((width_px - kLeft_px - kRight_px) / (columns * grid.cell_m),
                              (height_px - kTop_px - kBottom_px) / (rows * grid.cell_m));
  const int high = kTop_px + static_cast<int>(std::ceil(rows * grid.cell_m * place.pxPerMetre)) + kBottom_px;
  cv::Mat image(high, width_px, CV_8UC3, toBgr(kPaper));
  place.bottom = high - kBottom_px;
  place.left = std::max(kLeft_px, (width_px - static_cast<int>(columns * grid.cell_m * place.pxPerMetre)) / 2);
  place.west_m = grid.west_m;
  place.south_m = grid.south_m;
  drawAxes(image, grid, place);
  const ColourRamp ramp = depthRamp(grid, datum.height_m);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (!grid.hasValue(column, row)) continue;
      Rgb colour = ramp.at(grid.height_m[grid.index(column, row)]);
      const double light = relief(grid, column, row);
      for (auto& c : colour) c = static_cast<std::uint8_t>(std::clamp(std::lround(light * c), 0L, 255L));
      const Eigen::Vector2d m = grid.centre(column, row);
      const double half = 0.5 * grid.cell_m;
      cv::rectangle(image, cv::Point(place.x(m.x() - half), place.y(m.y() + half)),
                    cv::Point(place.x(m.x() + half), place.y(m.y() - half)), toBgr(colour), cv::FILLED);
    }
  drawColourBar(image, ramp, "Depth below " + datum.name() + " [m]", cv::Rect(kLeft_px, high - 42, width_px / 4, 16),
                datum.height_m, -1);
  return image;
}

}  // namespace s2s::products
