#include "s2s/eval/object_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "object_view.h"
#include "s2s/core/atomic_file.h"

namespace s2s::eval {

namespace {

/// Of longer objects the piece of this length is shown where the map has most points of it.
constexpr double kLongest_m = 4.0;
constexpr double kMargin_m = 0.35;
constexpr double kLeastScale_m = 0.15;  // a cable lies 8 cm high
constexpr int kSheetColumns = 3;

std::size_t countNear(const std::vector<ObjectPoint>& points, const Eigen::Vector3d& p, double radius_m) {
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](const ObjectPoint& point) {
    return point.layer == map::Layer::Stereo && (point.p_world - p).squaredNorm() < radius_m * radius_m;
  }));
}

/// The triangles of a piece of the object.
products::PlyMesh pieceOf(const products::PlyMesh& surface, const std::vector<ObjectPoint>& points) {
  Eigen::AlignedBox3d box;
  for (const auto& v : surface.vertices) box.extend(v);
  if (box.sizes().head<2>().norm() <= kLongest_m) return surface;
  constexpr std::size_t kTried = 200;
  const std::size_t step = std::max<std::size_t>(1, surface.vertices.size() / kTried);
  Eigen::Vector3d middle = surface.vertices.front();
  std::size_t most = 0;
  for (std::size_t i = 0; i < surface.vertices.size(); i += step) {
    const std::size_t count = countNear(points, surface.vertices[i], 0.25 * kLongest_m);
    if (count <= most) continue;
    most = count;
    middle = surface.vertices[i];
  }
  products::PlyMesh piece;
  piece.vertices = surface.vertices;
  for (const auto& triangle : surface.triangles)
    if (std::all_of(triangle.begin(), triangle.end(),
                    [&](const auto index) { return (surface.vertices[index] - middle).norm() < 0.5 * kLongest_m; }))
      piece.triangles.push_back(triangle);
  return piece.triangles.empty() ? surface : piece;
}

/// The longer horizontal axis of what the triangles cover.
Eigen::Vector3d longAxis(const products::PlyMesh& surface) {
  std::vector<Eigen::Vector2d> corners;
  for (const auto& triangle : surface.triangles)
    for (const auto index : triangle) corners.emplace_back(surface.vertices[index].head<2>());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& corner : corners) mean += corner / static_cast<double>(corners.size());
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (const auto& corner : corners) moments += (corner - mean) * (corner - mean).transpose();
  const double yaw_rad = 0.5 * std::atan2(2 * moments(0, 1), moments(0, 0) - moments(1, 1));
  return {std::cos(yaw_rad), std::sin(yaw_rad), 0};
}

/// Two rows, from above and from the side: the map on the left, the truth on the right.
cv::Mat pictureOf(const ObjectFinder& finder, std::size_t object, const ObjectPresence& presence) {
  const auto piece = pieceOf(finder.surfaceOf(object), finder.pointsOf(object));
  const double trueHeight_m = std::isfinite(presence.trueHeight_m) ? presence.trueHeight_m : 0;
  const HeightColours colours(std::max(kLeastScale_m, 1.2 * trueHeight_m));
  const auto height = [&finder](const Eigen::Vector3d& p) { return finder.heightAboveSeabed(p); };
  const Eigen::Vector3d right = longAxis(piece), up = Eigen::Vector3d::UnitZ();
  const bool whole = piece.triangles.size() == finder.surfaceOf(object).triangles.size();
  cv::Mat picture;
  for (const bool above : {true, false}) {
    const Eigen::Vector3d across = above ? up.cross(right) : up, towards = above ? up : right.cross(up);
    ObjectView mapped(piece, right, across, towards, kMargin_m), truth = mapped;
    mapped.drawPoints(finder.pointsOf(object), height, colours);
    mapped.drawOutline(piece);
    truth.drawSurface(piece, height, colours);
    truth.drawOutline(piece);
    const std::string name = presence.name + (whole ? "" : ", a piece");
    cv::Mat row;
    cv::hconcat(mapped.finish(name + (above ? ": map, from above" : ": map, side")),
                truth.finish(above ? "truth, from above" : "truth, side"), row);
    if (above)
      picture = row;
    else
      cv::vconcat(picture, row, picture);
  }
  cv::vconcat(picture, colours.legend(picture.cols), picture);
  return picture;
}

void write(const cv::Mat& picture, const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(path.extension().string(), picture, bytes);
  core::writeTextFile(path.string(), std::string(bytes.begin(), bytes.end()));
}

/// All pictures on one sheet, row by row, each row as high as its highest.
cv::Mat sheetOf(const std::vector<cv::Mat>& pictures) {
  cv::Mat sheet;
  for (std::size_t first = 0; first < pictures.size(); first += kSheetColumns) {
    const std::size_t end = std::min(pictures.size(), first + kSheetColumns);
    int height_px = 0;
    for (std::size_t i = first; i < end; ++i) height_px = std::max(height_px, pictures[i].rows);
    cv::Mat row(height_px, kSheetColumns * pictures[first].cols, CV_8UC3, cv::Scalar::all(0));
    for (std::size_t i = first; i < end; ++i)
      pictures[i].copyTo(row({static_cast<int>(i - first) * pictures[i].cols, 0, pictures[i].cols, pictures[i].rows}));
    if (sheet.empty())
      sheet = row;
    else
      cv::vconcat(sheet, row, sheet);
  }
  return sheet;
}

}  // namespace

void writeObjectPictures(const ObjectFinder& finder, const std::string& folder) {
  const auto presence = finder.presence();
  std::vector<cv::Mat> pictures;
  for (std::size_t i = 0; i < presence.size(); ++i) {
    if (finder.pointsOf(i).empty()) continue;
    pictures.push_back(pictureOf(finder, i, presence[i]));
    write(pictures.back(), std::filesystem::path(folder) / ("object_" + presence[i].name + ".png"));
  }
  if (!pictures.empty()) write(sheetOf(pictures), std::filesystem::path(folder) / "objects.jpg");
}

}  // namespace s2s::eval
