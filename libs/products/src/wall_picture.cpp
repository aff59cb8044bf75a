#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "picture_drawing.h"
#include "s2s/products/map_pictures.h"

namespace s2s::products {

namespace {

using Cell = map::WallEstimator::Cell;

constexpr int kLeft_px = 70, kTop_px = 34, kRight_px = 24, kBetween_px = 56, kLegend_px = 76;
constexpr double kLargestExaggeration = 4;
/// Offsets are shown up to the largest of all but this share.
constexpr double kBeyond = 0.05;

/// Blue where a face lies behind its wall's plane, red where it stands out.
ColourRamp offsetRamp(const std::vector<Cell>& cells) {
  std::vector<double> offsets;
  offsets.reserve(cells.size());
  for (const Cell& cell : cells) offsets.push_back(std::abs(cell.offset_m));
  std::sort(offsets.begin(), offsets.end());
  const double most =
      offsets.empty() ? 0 : offsets[static_cast<std::size_t>((1 - kBeyond) * static_cast<double>(offsets.size() - 1))];
  const double end = std::max(0.1, std::ceil(10 * most) / 10);
  return {-end, end, {{{30, 60, 150}}, {{110, 160, 215}}, {{232, 228, 214}}, {{230, 140, 90}}, {{160, 35, 35}}}};
}

/// The walls on one side of the survey, as seen from it.
struct Panel {
  std::string title;
  Eigen::Vector2d right = Eigen::Vector2d::UnitX();  ///< of the picture, in the map
  std::vector<const Cell*> cells;
  double low_m = 0, high_m = 0;  ///< along `right`, from the survey's middle
};

std::vector<Panel> panelsOf(const std::vector<Cell>& cells, const SurveyFrame& frame) {
  const Eigen::Vector2d along = frame.along, across = frame.across();
  std::array<Panel, 4> all;
  const std::array<Eigen::Vector2d, 4> ahead = {across, -across, along, -along};
  const std::array<const char*, 4> names = {
      "Walls left of the survey's direction, seen from it", "Walls right of the survey's direction, seen from it",
      "Walls across its direction, looking along it", "Walls across its direction, looking back"};
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].title = names[i];
    all[i].right = {ahead[i].y(), -ahead[i].x()};
  }
  for (const Cell& cell : cells) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < ahead.size(); ++i)
      if (ahead[i].dot(cell.outward_map) < ahead[best].dot(cell.outward_map)) best = i;
    Panel& panel = all[best];
    const double place_m = panel.right.dot(cell.p_map.head<2>() - frame.middle_m);
    panel.low_m = panel.cells.empty() ? place_m : std::min(panel.low_m, place_m);
    panel.high_m = panel.cells.empty() ? place_m : std::max(panel.high_m, place_m);
    panel.cells.push_back(&cell);
  }
  std::vector<Panel> used;
  for (Panel& panel : all)
    if (!panel.cells.empty()) used.push_back(std::move(panel));
  return used;
}

/// Where metres lie in one panel.
struct PanelPlace {
  double pxPerMetreX = 1, pxPerMetreY = 1, low_m = 0, top_m = 0;
  int top_px = 0;

  int x(double metres) const { return kLeft_px + static_cast<int>(std::lround((metres - low_m) * pxPerMetreX)); }
  int y(double height_m) const { return top_px + static_cast<int>(std::lround((top_m - height_m) * pxPerMetreY)); }
};

void drawAxes(cv::Mat& image, const Panel& panel, const PanelPlace& place, double bottom_m, const HeightDatum& datum) {
  const int left = place.x(panel.low_m), right = place.x(panel.high_m);
  const double stepX_m = roundStep(110 / place.pxPerMetreX), stepY_m = roundStep(60 / place.pxPerMetreY);
  for (const double at : ticks(panel.low_m, panel.high_m, stepX_m)) {
    cv::line(image, {place.x(at), place.y(place.top_m)}, {place.x(at), place.y(bottom_m)}, toBgr(kFaint), 1);
    drawText(image, stepText(at, stepX_m), place.x(at), place.y(bottom_m) + 16, Align::Centre);
  }
  for (const double height : ticks(bottom_m - datum.height_m, place.top_m - datum.height_m, stepY_m)) {
    const int y = place.y(datum.height_m + height);
    const bool water = datum.isWater && std::abs(height) < 1e-9;
    cv::line(image, {left, y}, {right, y}, toBgr(water ? kWaterColour : kFaint), 1);
    drawText(image, stepText(height, stepY_m), kLeft_px - 8, y + 5, Align::Right);
  }
  drawText(image, panel.title, kLeft_px, place.y(place.top_m) - 8);
}

}  // namespace

cv::Mat drawWalls(const std::vector<Cell>& cells, double cell_m, const SurveyFrame& frame, const HeightDatum& datum,
                  int width_px, int height_px) {
  const std::vector<Panel> panels = panelsOf(cells, frame);
  double bottom_m = datum.height_m, top_m = datum.height_m, longest_m = cell_m;
  for (const Cell& cell : cells) {
    bottom_m = std::min(bottom_m, cell.p_map.z() - cell_m);
    top_m = std::max(top_m, cell.p_map.z() + cell_m);
  }
  for (const Panel& panel : panels) longest_m = std::max(longest_m, panel.high_m - panel.low_m + cell_m);
  PanelPlace place;
  place.top_m = top_m;
  place.pxPerMetreX = (width_px - kLeft_px - kRight_px) / longest_m;
  const int count = std::max(1, static_cast<int>(panels.size()));
  const double room_px = static_cast<double>(height_px - kLegend_px) / count - kTop_px - kBetween_px;
  place.pxPerMetreY = std::clamp(room_px / std::max(cell_m, top_m - bottom_m), 0.25 * place.pxPerMetreX,
                                 kLargestExaggeration * place.pxPerMetreX);
  const int panel_px = kTop_px + static_cast<int>(std::ceil((top_m - bottom_m) * place.pxPerMetreY)) + kBetween_px;
  cv::Mat image(count * panel_px + kLegend_px, width_px, CV_8UC3, toBgr(kPaper));
  const ColourRamp ramp = offsetRamp(cells);
  place.top_px = kTop_px;
  for (const Panel& panel : panels) {
    place.low_m = panel.low_m;
    drawAxes(image, panel, place, bottom_m, datum);
    for (const Cell* cell : panel.cells) {
      const double at_m = panel.right.dot(cell->p_map.head<2>() - frame.middle_m), half_m = 0.5 * cell_m;
      cv::rectangle(image, cv::Point(place.x(at_m - half_m), place.y(cell->p_map.z() + half_m)),
                    cv::Point(place.x(at_m + half_m), place.y(cell->p_map.z() - half_m)),
                    toBgr(ramp.at(cell->offset_m)), cv::FILLED);
    }
    place.top_px += panel_px;
  }
  const int y = image.rows - 36;
  drawColourBar(image, ramp, "Out of the wall's plane [m]", cv::Rect(kLeft_px, y, width_px / 4, 14), 0, 1);
  std::string text =
      "above the " + datum.name() + " line by LiDAR, below by sonar; heights above " + datum.name() + " [m]";
  const double exaggeration = place.pxPerMetreY / place.pxPerMetreX;
  if (std::abs(exaggeration - 1) > 0.05) text += " x " + stepText(exaggeration, 0.1);
  drawText(image, text, image.cols - kRight_px, y + 12, Align::Right);
  return image;
}

}  // namespace s2s::products
