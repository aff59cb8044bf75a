#include "s2s/products/map_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "picture_drawing.h"
#include "splat_renderer.h"

namespace s2s::products {

namespace {

constexpr int kLegend_px = 92;         // band below the picture
constexpr double kTurn_rad = 0.45;     // of the oblique view against the path's direction
constexpr double kDescent_rad = 0.72;  // of its line of sight
constexpr double kCutBehindPath_m = 1.5;
constexpr double kLidarSize_m = 0.12, kSonarSize_m = 0.25;  // sonar points are sparser
constexpr double kLargestExaggeration = 8;
constexpr int kSectionBorder_px = 70;

Rgb layerColour(map::Layer layer) {
  constexpr std::array<Rgb, 4> kColours = {{{{150, 148, 144}}, {{222, 122, 30}}, {{40, 110, 180}}, {{30, 140, 96}}}};
  return kColours[static_cast<std::size_t>(layer)];
}

/// Rows: right, up, towards the viewer; the viewer looks along `heading` (horizontal) and down by `descent_rad`.
Eigen::Matrix3d viewAxes(const Eigen::Vector2d& heading, double descent_rad) {
  const Eigen::Vector3d ahead(heading.x(), heading.y(), 0), z = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d axes;
  axes.row(0) = ahead.cross(z).transpose();
  axes.row(1) = (std::sin(descent_rad) * ahead + std::cos(descent_rad) * z).transpose();
  axes.row(2) = (-std::cos(descent_rad) * ahead + std::sin(descent_rad) * z).transpose();
  return axes;
}

/// The eight corners of a box in the survey's frame.
std::vector<Eigen::Vector3d> corners(const SurveyFrame& frame, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                                     double bottom, double top) {
  std::vector<Eigen::Vector3d> out;
  for (const double s : {low.x(), high.x()})
    for (const double n : {low.y(), high.y()})
      for (const double z : {bottom, top}) out.push_back(frame.toMap(s, n, z));
  return out;
}

void drawPath(cv::Mat& image, const ParallelView& view, const core::Trajectory& path) {
  constexpr int kShift = 4;
  std::vector<cv::Point> line;
  for (const auto& pose : path.poses()) {
    const Eigen::Vector3d q = view.project(pose.T.translation());
    line.emplace_back(static_cast<int>(std::lround(q.x() * (1 << kShift))),
                      static_cast<int>(std::lround(q.y() * (1 << kShift))));
  }
  if (line.size() < 2) return;
  cv::polylines(image, line, false, toBgr(kPaper), 4, cv::LINE_AA, kShift);
  cv::polylines(image, line, false, toBgr(kPathColour), 2, cv::LINE_AA, kShift);
  cv::circle(image, line.front(), 5 << kShift, toBgr(kPaper), cv::FILLED, cv::LINE_AA, kShift);
  cv::circle(image, line.front(), 5 << kShift, toBgr(kPathColour), 2, cv::LINE_AA, kShift);
  cv::circle(image, line.back(), 4 << kShift, toBgr(kPathColour), cv::FILLED, cv::LINE_AA, kShift);
}

}  // namespace

struct MapPictures::Implementation {
  Implementation(const PictureContext& c, const PictureOptions& o)
      : context(c),
        options(o),
        bottom_m(c.statistics.heightQuantile_m(map::kSonarLayers, 0.005)),
        top_m(c.statistics.heightQuantile_m({map::Layer::Lidar}, 0.995)),
        colours(c.datum.height_m, c.statistics.heightQuantile_m({map::Layer::Lidar}, 0.97), bottom_m,
                std::min(c.datum.height_m, c.statistics.heightQuantile_m(map::kSonarLayers, 0.98))),
        low_m(c.frame.low_m.array() - o.margin_m),
        high_m(c.frame.high_m.array() + o.margin_m),
        obliqueView(makeOblique(), kPaper, SplatRenderer::Shading::EyeDome),
        topView(makeTop(), kPaper, SplatRenderer::Shading::EyeDome),
        longView(makeLong(), kPaper, SplatRenderer::Shading::None),
        crossView(makeCross(), kPaper, SplatRenderer::Shading::None) {}

  ParallelView plainView(const Eigen::Matrix3d& axes) const {
    ParallelView view;
    view.axes = axes;
    view.width_px = options.width_px;
    view.height_px = options.height_px - kLegend_px;
    return view;
  }
  ParallelView makeOblique() const {
    const Eigen::Rotation2Dd turn(-kTurn_rad);
    ParallelView view = plainView(viewAxes(turn * context.frame.across(), kDescent_rad));
    const Eigen::Vector2d nearEdge(low_m.x(), context.frame.low_m.y() - kCutBehindPath_m);
    view.fit(corners(context.frame, nearEdge, high_m, bottom_m, top_m), 20);
    return view;
  }
  ParallelView makeTop() const {
    ParallelView view = plainView(viewAxes(context.frame.across(), M_PI / 2));
    view.fit(corners(context.frame, low_m, high_m, 0, 0), 12);
    return view;
  }
  ParallelView makeLong() const {
    ParallelView view = plainView(viewAxes(context.frame.across(), 0));
    view.height_px = options.height_px / 2;
    view.fit(corners(context.frame, low_m, high_m, sectionBottom(), sectionTop()), kSectionBorder_px,
             kLargestExaggeration);
    return view;
  }
  ParallelView makeCross() const {
    // Looks along the path's direction, so that "across" grows to the left as the path sees it.
    ParallelView view = plainView(viewAxes(context.frame.along, 0));
    view.height_px = options.height_px;
    view.fit(corners(context.frame, low_m, high_m, sectionBottom(), sectionTop()), kSectionBorder_px);
    return view;
  }
  double sectionBottom() const { return std::min(bottom_m, context.datum.height_m) - 0.5; }
  double sectionTop() const { return std::max(top_m, context.datum.height_m) + 0.5; }

  void drawLegend(cv::Mat& image, const ParallelView& view) const;
  cv::Mat withLegend(const SplatRenderer& renderer) const;
  cv::Mat section(const SplatRenderer& renderer, const std::string& title, const std::string& axis) const;
  void drawHeightAxis(cv::Mat& image, const ParallelView& view) const;
  void drawLengthAxis(cv::Mat& image, const ParallelView& view, const std::string& axis) const;

  PictureContext context;
  PictureOptions options;
  double bottom_m, top_m;  ///< heights between which nearly all points lie
  MapColours colours;
  Eigen::Vector2d low_m, high_m;  ///< part of the survey frame that is drawn
  SplatRenderer obliqueView, topView, longView, crossView;
};

MapPictures::MapPictures(const PictureContext& context, const PictureOptions& options)
    : implementation_(std::make_unique<Implementation>(context, options)) {}
MapPictures::~MapPictures() = default;
MapPictures::MapPictures(MapPictures&&) noexcept = default;
MapPictures& MapPictures::operator=(MapPictures&&) noexcept = default;

void MapPictures::add(const map::MapPoint& point) {
  Implementation& my = *implementation_;
  const SurveyFrame& frame = my.context.frame;
  const Eigen::Vector2d place = frame.local(point.p_map);
  if (!((place.array() >= my.low_m.array()).all() && (place.array() <= my.high_m.array()).all())) return;
  const bool lidar = point.layer == map::Layer::Lidar;
  const Rgb colour = (lidar ? my.colours.lidar : my.colours.sonar).at(point.p_map.z());
  const double size_m = lidar ? kLidarSize_m : kSonarSize_m;
  if (!lidar || place.y() >= frame.low_m.y() - kCutBehindPath_m) my.obliqueView.add(point.p_map, colour, size_m);
  my.topView.add(point.p_map, colour, size_m);
  const double half_m = 0.5 * my.options.sectionThickness_m;
  const auto dot_m = [&](const SplatRenderer& view) { return (lidar ? 1.3 : 1.6) / view.view().pxPerMetreX; };
  if (std::abs(place.y()) <= half_m) my.longView.add(point.p_map, layerColour(point.layer), dot_m(my.longView));
  if (std::abs(place.x() - my.context.crossSectionStation_m) <= half_m)
    my.crossView.add(point.p_map, layerColour(point.layer), dot_m(my.crossView));
}

cv::Mat MapPictures::oblique() const { return implementation_->withLegend(implementation_->obliqueView); }

cv::Mat MapPictures::top() const { return implementation_->withLegend(implementation_->topView); }

cv::Mat MapPictures::longSection() const {
  return implementation_->section(implementation_->longView, "Long section", "along the survey [m]");
}

cv::Mat MapPictures::crossSection() const {
  return implementation_->section(
      implementation_->crossView,
      "Cross section at " + stepText(implementation_->context.crossSectionStation_m, 1) + " m along the survey",
      "across the survey [m]");
}

void MapPictures::Implementation::drawLegend(cv::Mat& image, const ParallelView& view) const {
  const int top = view.height_px, bar = image.cols / 5;
  cv::line(image, {0, top}, {image.cols, top}, toBgr(kFaint), 1);
  drawScaleBar(image, view.pxPerMetreX, 24, top + 44, image.cols / 6);
  drawColourBar(image, colours.sonar, "Sonar: depth below " + context.datum.name() + " [m]",
                cv::Rect(image.cols / 4, top + 34, bar, 16), context.datum.height_m, -1);
  drawColourBar(image, colours.lidar, "LiDAR: height above " + context.datum.name() + " [m]",
                cv::Rect(image.cols / 4 + bar + image.cols / 16, top + 34, bar, 16), context.datum.height_m, 1);
  drawKey(image, kPathColour, "path (ring: start)", image.cols - image.cols / 5, top + 48);
}

cv::Mat MapPictures::Implementation::withLegend(const SplatRenderer& renderer) const {
  cv::Mat image(renderer.view().height_px + kLegend_px, options.width_px, CV_8UC3, toBgr(kPaper));
  cv::Mat upper = image(cv::Rect(0, 0, options.width_px, renderer.view().height_px));
  renderer.image().copyTo(upper);
  drawPath(upper, renderer.view(), context.path);
  drawLegend(image, renderer.view());
  return image;
}

void MapPictures::Implementation::drawHeightAxis(cv::Mat& image, const ParallelView& view) const {
  const double step_m = roundStep(std::max(1e-3, 2 * 40 / view.pxPerMetreY));
  const int left = kSectionBorder_px, right = image.cols - kSectionBorder_px;
  const double low = sectionBottom() - context.datum.height_m, high = sectionTop() - context.datum.height_m;
  for (const double height : ticks(low, high, step_m)) {
    const Eigen::Vector3d place =
        view.centre_m + Eigen::Vector3d(0, 0, context.datum.height_m + height - view.centre_m.z());
    const int y = static_cast<int>(std::lround(view.project(place).y()));
    const bool water = context.datum.isWater && std::abs(height) < 1e-9;
    cv::line(image, {left, y}, {right, y}, toBgr(water ? kWaterColour : kFaint), 1);
    drawText(image, stepText(height, step_m), left - 8, y + 5, Align::Right);
  }
  drawText(image, "height above " + context.datum.name() + " [m]", left, 24);
}

void MapPictures::Implementation::drawLengthAxis(cv::Mat& image, const ParallelView& view,
                                                 const std::string& axis) const {
  const double step_m = roundStep(std::max(1e-3, 2 * 60 / view.pxPerMetreX));
  const int top = kSectionBorder_px - 30, bottom = image.rows - kSectionBorder_px + 20;
  // The axis counts along the picture's right, from the survey's middle.
  const Eigen::Vector3d right = view.axes.row(0).transpose();
  const Eigen::Vector3d middle = context.frame.toMap(0, 0, 0);
  const double half_m = 0.5 * (view.width_px - 2 * kSectionBorder_px) / view.pxPerMetreX;
  const double centre_m = right.dot(view.centre_m - middle);
  for (const double at : ticks(centre_m - half_m, centre_m + half_m, step_m)) {
    const int x = static_cast<int>(std::lround(view.project(middle + at * right).x()));
    cv::line(image, {x, top}, {x, bottom}, toBgr(kFaint), 1);
    drawText(image, stepText(at, step_m), x, bottom + 18, Align::Centre);
  }
  drawText(image, axis, image.cols - kSectionBorder_px, bottom + 38, Align::Right);
}

cv::Mat MapPictures::Implementation::section(const SplatRenderer& renderer, const std::string& title,
                                             const std::string& axis) const {
  const ParallelView& view = renderer.view();
  cv::Mat axes(view.height_px, view.width_px, CV_8UC3, toBgr(kPaper));
  drawLengthAxis(axes, view, axis);
  drawHeightAxis(axes, view);
  cv::Mat image;
  cv::min(axes, renderer.image(), image);  // the darker of both: points over faint lines
  int x = kSectionBorder_px;
  const int y = image.rows - kSectionBorder_px + 58;
  for (const auto layer : map::kLayers) {
    std::string name = map::layerName(layer);
    std::replace(name.begin(), name.end(), '_', ' ');
    x = drawKey(image, layerColour(layer), name, x, y);
  }
  if (context.datum.isWater) drawKey(image, kWaterColour, "water surface", x, y);
  const double exaggeration = view.pxPerMetreY / view.pxPerMetreX;
  std::string text = title + ", " + stepText(options.sectionThickness_m, 0.1) + " m thick";
  if (exaggeration > 1.05) text += ", heights x " + stepText(exaggeration, 0.1);
  drawText(image, text, image.cols - kSectionBorder_px, 24, Align::Right);
  return image;
}

}  // namespace s2s::products
