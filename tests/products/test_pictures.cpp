#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "picture_drawing.h"
#include "s2s/core/error.h"
#include "s2s/products/map_pictures.h"
#include "sample_map.h"
#include "splat_renderer.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

using test::TempFolder;
using test::writeBytes;

constexpr Rgb kRed = {200, 30, 30}, kBlue = {30, 30, 200};

Rgb pixel(const cv::Mat& image, int x, int y) {
  const auto& bgr = image.at<cv::Vec3b>(y, x);
  return {bgr[2], bgr[1], bgr[0]};
}

bool same(const cv::Mat& a, const cv::Mat& b) { return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0; }

ParallelView topView() {
  ParallelView view;  // x right, y up, seen from above
  view.width_px = 100;
  view.height_px = 80;
  view.pxPerMetreX = view.pxPerMetreY = 10;
  return view;
}

TEST(ColourRamp, EndsMiddleAndOutside) {
  const ColourRamp ramp(0, 10, {{{0, 0, 0}}, {{100, 50, 200}}});
  EXPECT_EQ(ramp.at(0), (Rgb{0, 0, 0}));
  EXPECT_EQ(ramp.at(5), (Rgb{50, 25, 100}));
  EXPECT_EQ(ramp.at(99), (Rgb{100, 50, 200}));
  EXPECT_EQ(ramp.at(-1), (Rgb{0, 0, 0}));
  EXPECT_EQ(ramp.at(std::nan("")), (Rgb{0, 0, 0}));
}

TEST(ParallelView, Fit_PutsTheFarthestCornersOnTheBorder) {
  ParallelView view = topView();
  view.fit({{2, 1, 0}, {10, 3, 5}}, 10);
  EXPECT_DOUBLE_EQ(view.pxPerMetreX, 10);  // 80 px for 8 m
  EXPECT_DOUBLE_EQ(view.pxPerMetreY, 10);
  EXPECT_NEAR(view.project({2, 1, 0}).x(), 10, 1e-9);
  EXPECT_NEAR(view.project({10, 3, 5}).x(), 90, 1e-9);
  EXPECT_EQ(view.height_px, 40);  // 2 m and two borders: the rest of the 80 px is not needed
  EXPECT_NEAR(view.project({6, 3, 0}).y(), 10, 1e-9);
  view.height_px = 80;
  view.fit({{2, 1, 0}, {10, 3, 5}}, 10, 2);
  EXPECT_DOUBLE_EQ(view.pxPerMetreY, 20);  // 30 would fit, twice the horizontal scale is allowed
  EXPECT_EQ(view.height_px, 60);
}

TEST(ParallelView, Fit_OfOnePointStaysFinite) {
  ParallelView view = topView();
  view.fit({{1, 2, 3}}, 5);
  EXPECT_TRUE(std::isfinite(view.pxPerMetreX));
  EXPECT_NEAR(view.project({1, 2, 3}).x(), 50, 1e-9);
}

TEST(SplatRenderer, NearerPointHidesFartherInAnyOrder) {
  for (const bool nearFirst : {true, false}) {
    SplatRenderer renderer(topView(), kPaper, SplatRenderer::Shading::None);
    for (const bool isNear : {nearFirst, !nearFirst})
      renderer.add({0, 0, isNear ? 5.0 : 1.0}, isNear ? kRed : kBlue, 0.4);
    EXPECT_EQ(pixel(renderer.image(), 50, 40), kRed);
  }
}

TEST(SplatRenderer, Point_LandsWhereTheProjectionPutsIt) {
  SplatRenderer renderer(topView(), kPaper, SplatRenderer::Shading::None);
  renderer.add({3, 2, 0}, kRed, 0.4);  // 30 px to the right of the middle, 20 up; 4 px wide
  renderer.add({100, 0, 0}, kRed, 0.4);
  renderer.add({std::nan(""), 0, 0}, kRed, 0.4);
  const cv::Mat image = renderer.image();
  EXPECT_EQ(pixel(image, 80, 20), kRed);
  EXPECT_EQ(pixel(image, 74, 20), kPaper);
  EXPECT_EQ(pixel(image, 80, 26), kPaper);
}

TEST(SplatRenderer, Pinhole_IsClosedAndAWideGapIsNot) {
  SplatRenderer renderer(topView(), kPaper, SplatRenderer::Shading::None);
  // The renderer works at half pixels: points 0.05 m apart lie side by side; one is left out, and a square of 1 m.
  for (int x = -60; x < 60; ++x)
    for (int y = -60; y < 60; ++y)
      if (!(x == 0 && y == 0) && !(x > 20 && x < 40 && y > 20 && y < 40))
        renderer.add({0.05 * x + 0.025, 0.05 * y + 0.025, 0}, kBlue, 0);
  const cv::Mat image = renderer.image();
  EXPECT_EQ(pixel(image, 50, 39), kBlue);
  EXPECT_EQ(pixel(image, 65, 25), kPaper);
}

TEST(SplatRenderer, EyeDomeShading_DarkensBehindAStepAndLeavesAPlane) {
  SplatRenderer renderer(topView(), kPaper, SplatRenderer::Shading::EyeDome);
  for (int x = -100; x < 100; ++x)
    for (int y = -80; y < 80; ++y) renderer.add({0.05 * x + 0.025, 0.05 * y + 0.025, x < 0 ? 3.0 : 0.0}, kBlue, 0);
  const cv::Mat image = renderer.image();
  EXPECT_EQ(pixel(image, 20, 40), kBlue);
  EXPECT_EQ(pixel(image, 80, 40), kBlue);
  EXPECT_LT(pixel(image, 50, 40)[2], 0.7 * kBlue[2]) << "the low side, beside the step";
  EXPECT_EQ(pixel(image, 48, 40), kBlue) << "the high side";
}

TEST(PictureDrawing, RoundStepsAndTheirTexts) {
  EXPECT_DOUBLE_EQ(roundStep(7.3), 5);
  EXPECT_DOUBLE_EQ(roundStep(0.21), 0.2);
  EXPECT_DOUBLE_EQ(roundStep(100), 100);
  EXPECT_EQ(stepText(12.345, 0.1), "12.3");
  EXPECT_EQ(stepText(12.345, 5), "12");
  EXPECT_EQ(stepText(-0.01, 0.1), "0.0");
  EXPECT_EQ(ticks(-5, 11, 5), (std::vector<double>{-5, 0, 5, 10}));
  EXPECT_TRUE(ticks(1, 4, 5).empty());
}

TEST(SurveyFrame, DiagonalPath_GivesItsDirectionMiddleAndExtent) {
  core::Trajectory path;
  const Eigen::Vector2d direction = Eigen::Vector2d(3, 4) / 5;
  // Sailed against x; "along" still points to growing x.
  for (int i = 0; i <= 100; ++i) {
    const Eigen::Vector2d p = Eigen::Vector2d(7, -2) + (100 - i) * 0.5 * direction;
    path.append(i, core::isometryFromXyzYpr(p.x(), p.y(), 0.1, 0, 0, 0));
  }
  const SurveyFrame frame(path, {});
  EXPECT_LT((frame.along - direction).norm(), 1e-9);
  EXPECT_LT((frame.middle_m - Eigen::Vector2d(7, -2) - 25 * direction).norm(), 1e-9);
  EXPECT_NEAR(frame.high_m.x(), 25, 1e-9);
  EXPECT_NEAR(frame.low_m.y(), 0, 1e-9);
  const Eigen::Vector3d p = frame.toMap(3, -2, 9);
  EXPECT_LT((frame.local(p) - Eigen::Vector2d(3, -2)).norm(), 1e-9);
  // Across is to the left of along.
  EXPECT_GT(frame.along.x() * frame.across().y() - frame.along.y() * frame.across().x(), 0.99);
}

TEST(SurveyFrame, NoPath_TakesTheMapsBox) {
  CloudStatistics statistics;
  map::MapPoint p;
  for (const double x : {10.0, 30.0}) {
    p.p_map = {x, 0.5 * x, 0};
    statistics.add(p);
  }
  const SurveyFrame frame({}, statistics);
  EXPECT_EQ(frame.middle_m, Eigen::Vector2d(20, 10));
  EXPECT_EQ(frame.high_m, Eigen::Vector2d(10, 5));
}

TEST(CrossSectionFinder, TakesTheSlabWithBothLidarAndSonar) {
  CrossSectionFinder finder(SurveyFrame{}, 2);
  map::MapPoint p;
  const auto add = [&](double x, map::Layer layer, int count) {
    p.p_map.x() = x;
    p.layer = layer;
    for (int i = 0; i < count; ++i) finder.add(p);
  };
  EXPECT_EQ(finder.station_m(), 0);
  add(1, map::Layer::Lidar, 1000);  // no sonar here
  add(11, map::Layer::Lidar, 50);
  add(11, map::Layer::Stereo, 30);
  add(21, map::Layer::Lidar, 60);
  add(21, map::Layer::LineVertical, 20);
  EXPECT_EQ(finder.station_m(), 11);
}

TEST(CloudStatistics, CountsBoundsAndQuantiles) {
  CloudStatistics statistics;
  map::MapPoint p;
  for (int i = 0; i < 1000; ++i) {
    p.p_map = {0.01 * i, 5, 0.01 * i};
    p.intensity = static_cast<float>(i);
    EXPECT_TRUE(statistics.add(p));
  }
  p.p_map.z() = std::nan("");
  EXPECT_FALSE(statistics.add(p));
  EXPECT_EQ(statistics.count(), 1000U);
  EXPECT_EQ(statistics.notFinite(), 1U);
  EXPECT_EQ(statistics.layer(map::Layer::Lidar).maxIntensity, 999);
  EXPECT_EQ(statistics.box().max(), Eigen::Vector3d(9.99, 5, 9.99));
  // Heights are even over 0 to 10 m; bins of 0.1 m.
  EXPECT_NEAR(statistics.heightQuantile_m({map::Layer::Lidar}, 0.25), 2.5, 0.1);
  EXPECT_EQ(statistics.heightQuantile_m({map::Layer::Stereo}, 0.5), 0);
}

PictureContext contextOf(const SampleMap& map) {
  PictureContext context;
  for (const auto layer : map::kLayers) map.source()(layer, [&](const map::MapPoint& p) { context.statistics.add(p); });
  context.path = map.trajectories().optimised;
  context.frame = SurveyFrame(context.path, context.statistics);
  return context;
}

std::vector<map::MapPoint> pointsOf(const SampleMap& map) {
  std::vector<map::MapPoint> points;
  for (const auto layer : map::kLayers) map.source()(layer, [&](const map::MapPoint& p) { points.push_back(p); });
  return points;
}

TEST(MapPictures, OrderOfPoints_DoesNotMatter) {
  const SampleMap map;
  PictureOptions options;
  options.width_px = 400;
  options.height_px = 300;
  MapPictures forward(contextOf(map), options), backward(contextOf(map), options);
  auto points = pointsOf(map);
  for (const auto& p : points) forward.add(p);
  std::reverse(points.begin(), points.end());
  for (const auto& p : points) backward.add(p);
  EXPECT_TRUE(same(forward.oblique(), backward.oblique()));
  EXPECT_TRUE(same(forward.top(), backward.top()));
  EXPECT_TRUE(same(forward.crossSection(), backward.crossSection()));
}

TEST(MapPictures, Sizes_StayWithinThoseAskedForAndPointsAreDrawn) {
  const SampleMap map;
  PictureOptions options;
  options.width_px = 640;
  options.height_px = 480;
  MapPictures pictures(contextOf(map), options);
  const cv::Mat before = pictures.oblique();
  for (const auto& p : pointsOf(map)) pictures.add(p);
  for (const cv::Mat& image : {pictures.oblique(), pictures.top(), pictures.longSection(), pictures.crossSection()}) {
    EXPECT_EQ(image.cols, 640);
    EXPECT_LE(image.rows, 480);
    EXPECT_GE(image.rows, 140);  // more than legend and borders
  }
  EXPECT_FALSE(same(pictures.oblique(), before));
}

TEST(MapPictures, LidarNearerThanThePath_IsCutFromTheObliqueViewOnly) {
  const SampleMap map;
  PictureOptions options;
  options.width_px = 400;
  options.height_px = 300;
  MapPictures empty(contextOf(map), options), pictures(contextOf(map), options);
  map::MapPoint p;
  p.p_map = {30, -10, 1};  // a quay to the right of the path, which is the viewer's side
  pictures.add(p);
  EXPECT_TRUE(same(pictures.oblique(), empty.oblique()));
  EXPECT_FALSE(same(pictures.top(), empty.top()));
  p.layer = map::Layer::Stereo;
  pictures.add(p);
  EXPECT_FALSE(same(pictures.oblique(), empty.oblique()));
}

TEST(MapPictures, EmptyMapWithoutPath_IsStillDrawn) {
  MapPictures pictures(PictureContext{}, PictureOptions{});
  EXPECT_FALSE(pictures.oblique().empty());
  EXPECT_FALSE(pictures.longSection().empty());
}

TEST(DrawGrid, EmptyCellsStayPaper) {
  HeightGrid grid(0, 0, 1, 2, 1);
  EXPECT_FALSE(drawGrid(HeightGrid(0, 0, 1, 0, 0), {}, 400, 300).empty());
  const cv::Mat nothing = drawGrid(grid, {}, 400, 300);
  grid.height_m[0] = -3;
  const cv::Mat one = drawGrid(grid, {}, 400, 300);
  cv::Mat difference;
  cv::absdiff(one, nothing, difference);
  // The western half changes; the eastern one only where the colour bar's labels stand, far below.
  const int middle = one.rows - 110 - 40;
  EXPECT_GT(cv::norm(difference(cv::Rect(100, middle, 80, 20)), cv::NORM_L1), 0);
  EXPECT_EQ(cv::norm(difference(cv::Rect(260, middle, 80, 20)), cv::NORM_L1), 0);
}

/// A wall to the left of a survey along x, 20 m by 4 m; its upper half stands out of its plane.
std::vector<map::WallEstimator::Cell> wallToTheLeft(double out_m) {
  std::vector<map::WallEstimator::Cell> cells;
  for (double x = -9.875; x < 10; x += 0.25)
    for (double z = -1.875; z < 2; z += 0.25) {
      map::WallEstimator::Cell cell;
      cell.p_map = {x, 5, z};
      cell.outward_map = {0, -1};
      cell.offset_m = z > 0 ? out_m : -out_m;
      cell.bySonar = z < 0;
      cells.push_back(cell);
    }
  return cells;
}

TEST(DrawWalls, FacesThatStandOutAreRedAboveThoseBehindInBlue) {
  const cv::Mat image = drawWalls(wallToTheLeft(0.1), 0.25, {}, {}, 800, 400);
  ASSERT_EQ(image.cols, 800);
  double redRow = 0, blueRow = 0, red = 0, blue = 0;
  for (int row = 0; row < image.rows - 76; ++row)  // the legend has both
    for (int column = 0; column < image.cols; ++column) {
      const auto bgr = image.at<cv::Vec3b>(row, column);
      if (bgr[2] > bgr[0] + 80) redRow += row, ++red;
      if (bgr[0] > bgr[2] + 80) blueRow += row, ++blue;
    }
  // 20 m over 706 px, so that 2 m are 71 px without exaggeration: each half fills at least that.
  EXPECT_GT(red, 706 * 60);
  EXPECT_GT(blue, 706 * 60);
  EXPECT_LT(redRow / red, blueRow / blue);
}

TEST(DrawWalls, WallsOnTwoSides_HaveAPanelEachAndNoneIsNoFault) {
  const auto redBands = [](const std::vector<map::WallEstimator::Cell>& cells) {
    const cv::Mat image = drawWalls(cells, 0.25, {}, {}, 800, 400);
    int bands = 0;
    bool was = false;
    for (int row = 0; row < image.rows - 76; ++row) {
      const auto bgr = image.at<cv::Vec3b>(row, 300);
      const bool is = bgr[2] > bgr[0] + 80;
      bands += is && !was ? 1 : 0;
      was = is;
    }
    return bands;
  };
  auto cells = wallToTheLeft(0.1);
  EXPECT_EQ(redBands(cells), 1);
  for (auto cell : wallToTheLeft(0.1)) {
    cell.p_map.y() = -5;
    cell.outward_map = {0, 1};
    cells.push_back(cell);
  }
  EXPECT_EQ(redBands(cells), 2);
  EXPECT_EQ(redBands({}), 0);
}

TEST(WritePicture, PngReadsBack) {
  const TempFolder folder;
  cv::Mat image(20, 30, CV_8UC3, cv::Scalar(10, 20, 30));
  writePicture(folder.file("a.png"), image);
  EXPECT_TRUE(same(cv::imread(folder.file("a.png")), image));
  writeBytes(folder.file("taken"), "x");
  EXPECT_THROW(writePicture(folder.file("taken/a.png"), image), core::OutputError);
}

}  // namespace
}  // namespace s2s::products
