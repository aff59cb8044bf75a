#include "inspector.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "ping_view.h"
#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/core/transform.h"

namespace s2s::inspect {

namespace {

const cv::Scalar kGreen(80, 255, 80), kRed(80, 80, 255), kGray(130, 130, 130);
constexpr std::size_t kDrawnMatches = 80;

/// Both projections of the same drawing.
template <class Draw>
void drawBoth(const cv::Mat& image, const sonar::PingGeometry& geometry, const Draw& draw) {
  auto polar = polarView(image, geometry), cartesian = cartesianView(image, geometry);
  draw(polar, "polar");
  draw(cartesian, "cartesian");
}

std::string describe(const sonar::StereoCounts& n, std::size_t points) {
  std::ostringstream text;
  text << "features " << n.features_h << " + " << n.features_v << ", clusters " << n.clusters_h << " + " << n.clusters_v
       << " in " << n.clusterPairs << " pairs, surfaces " << n.surfaces << ", candidates " << n.candidates
       << ", ambiguous " << n.ambiguous << ", matches " << n.matches << ", points " << points << " (gates: residual "
       << n.outsideResidual << ", aperture " << n.outsideAperture << ", sigma " << n.outsideSigma << ")";
  return text.str();
}

/// A plan of the points: one metre is 80 pixels, the sonar at the bottom, the second coordinate to the left.
cv::Mat plan(const std::vector<sonar::StereoPoint>& points, int axis, double reach_m, const std::string& title) {
  constexpr double kScale = 80;
  const int height = static_cast<int>(reach_m * kScale), width = 640;
  cv::Mat picture(height, width, CV_8UC3, cv::Scalar(25, 20, 20));
  for (int x_m = 1; x_m < reach_m; ++x_m) {
    const int row = height - static_cast<int>(x_m * kScale);
    cv::line(picture, {0, row}, {width, row}, {60, 60, 50}, 1);
    cv::putText(picture, cv::format("%d m", x_m), {4, row - 3}, cv::FONT_HERSHEY_SIMPLEX, 0.4, {180, 180, 180});
  }
  for (const auto& point : points) {
    const cv::Point at(width / 2 - static_cast<int>(std::lround(point.p_h[axis] * kScale)),
                       height - static_cast<int>(std::lround(point.p_h.x() * kScale)));
    cv::circle(picture, at, 1, colorOf(static_cast<int>(point.residual * 20)), cv::FILLED);
  }
  drawTitle(picture, title);
  return picture;
}

}  // namespace

Inspector::Inspector(const sonar::SonarOptions& options, std::string folder)
    : options_(options), stereo_(options.horizontal, options.vertical, options.stereo), folder_(std::move(folder)) {}

void Inspector::write(const std::string& name, const cv::Mat& picture) {
  const std::string path = folder_ + "/" + name + ".png";
  core::AtomicFile file(path);
  if (!cv::imwrite(file.temporaryPath(), picture))
    throw core::OutputError("the picture cannot be written", path, "check the folder and the free space");
  file.commit();
  ++pictures_;
}

void Inspector::inspectDevice(const std::string& name, const sonar::SonarDevice& device,
                              const obs::CObservationImagingSonar& ping) {
  std::vector<sonar::PreprocessStage> stages;
  device.preprocessor().process(ping, &stages);
  const auto processed = device.process(ping);
  int number = 0;
  for (const auto& stage : stages) {
    const std::string prefix = name + "_" + std::to_string(number++) + "_" + stage.name;
    drawBoth(stage.image, processed.geometry, [&](PingView& view, const std::string& kind) {
      drawTitle(view.picture, name + ": " + stage.name);
      write(prefix + "_" + kind, view.picture);
    });
  }
  const std::string prefix = name + "_" + std::to_string(number) + "_leading_edge_";
  drawBoth(processed.image, processed.geometry, [&](PingView& view, const std::string& kind) {
    for (const auto& r : processed.lineScan.returns)
      drawDot(view, r.bin, r.beam, r.order == 0 ? kGreen : kRed, kind == "polar" ? 1 : 2);
    drawTitle(view.picture, name + ": leading edge");
    write(prefix + kind, view.picture);
  });
  std::size_t first = 0;
  for (const auto& r : processed.lineScan.returns) first += r.order == 0 ? 1 : 0;
  report_ += name + ": leading edge on " + std::to_string(first) + " of " + std::to_string(ping.beamCount) + " beams\n";
}

void Inspector::drawFeatures(const std::string& name, const sonar::ProcessedPing& ping, const sonar::Overlap& overlap,
                             const std::vector<sonar::Feature>& features) {
  drawBoth(ping.image, ping.geometry, [&](PingView& view, const std::string& kind) {
    for (std::size_t beam = 0; beam < overlap.bins.size(); ++beam) {
      if (overlap.bins[beam].first == overlap.bins[beam].second) continue;
      drawDot(view, overlap.bins[beam].first, static_cast<double>(beam), kGray, 0);
      drawDot(view, overlap.bins[beam].second - 1, static_cast<double>(beam), kGray, 0);
    }
    PingView clusters = view;
    clusters.picture = view.picture.clone();
    for (const auto& f : features) {
      drawDot(view, f.bin, f.beam, kGreen, 0);
      drawDot(clusters, f.bin, f.beam, f.cluster < 0 ? kGray : colorOf(f.cluster), 0);
    }
    drawTitle(view.picture, name + ": features in the overlap");
    drawTitle(clusters.picture, name + ": clusters");
    write(name + "_features_" + kind, view.picture);
    write(name + "_clusters_" + kind, clusters.picture);
  });
}

void Inspector::drawMatches(const sonar::ProcessedPing& h, const sonar::ProcessedPing& v,
                            const sonar::StereoTrace& trace) {
  auto left = cartesianView(h.image, h.geometry), right = cartesianView(v.image, v.geometry);
  drawTitle(left.picture, "horizontal");
  drawTitle(right.picture, "vertical");
  cv::Mat both = sideBySide(left.picture, right.picture);
  const int height = both.rows;
  const auto pixel = [&](const PingView& view, const sonar::Feature& f, int offset) {
    const cv::Point2d p = view.toPixel(f.bin, f.beam);
    return cv::Point(offset + static_cast<int>(std::lround(p.x)),
                     height - view.picture.rows + static_cast<int>(std::lround(p.y)));
  };
  const std::size_t step = std::max<std::size_t>(1, trace.matches.size() / kDrawnMatches);
  for (std::size_t i = 0; i < trace.matches.size(); ++i) {
    const auto a = pixel(left, trace.features_h[trace.matches[i].horizontal], 0);
    const auto b = pixel(right, trace.features_v[trace.matches[i].vertical], left.picture.cols + 10);
    const cv::Scalar color = colorOf(static_cast<int>(i));
    if (i % step == 0) cv::line(both, a, b, color, 1, cv::LINE_AA);
    cv::circle(both, a, 1, color, cv::FILLED);
    cv::circle(both, b, 1, color, cv::FILLED);
  }
  write("stereo_matches", both);
}

void Inspector::drawPoints(const sonar::StereoResult& result) {
  const double reach_m = 10;
  write("stereo_points",
        sideBySide(plan(result.points, 1, reach_m, "points from above the horizontal plane (x up, y left)"),
                   plan(result.points, 2, reach_m, "points from the side (x up, z left)")));
}

void Inspector::inspectPair(const obs::CObservationImagingSonar& h, const obs::CObservationImagingSonar& v) {
  const auto ping_h = stereo_.horizontal().process(h), ping_v = stereo_.vertical().process(v);
  const core::Isometry T_h_v = core::toIsometry(h.sensorPose).inverse() * core::toIsometry(v.sensorPose);
  sonar::StereoTrace trace;
  const auto result = stereo_.process(ping_h, ping_v, T_h_v, &trace);
  report_ += "stereo: " + std::string(sonar::statusText(result.status)) + "; " +
             describe(result.counts, result.points.size()) + "\n";
  drawFeatures("horizontal", ping_h, trace.overlap_h, trace.features_h);
  drawFeatures("vertical", ping_v, trace.overlap_v, trace.features_v);
  drawMatches(ping_h, ping_v, trace);
  drawPoints(result);
}

std::string Inspector::inspect(const PingPair& pings) {
  report_.clear();
  if (pings.horizontal) inspectDevice("horizontal", stereo_.horizontal(), *pings.horizontal);
  if (pings.vertical) inspectDevice("vertical", stereo_.vertical(), *pings.vertical);
  if (pings.horizontal && pings.vertical) inspectPair(*pings.horizontal, *pings.vertical);
  core::writeTextFile(folder_ + "/effective.ini", sonar::printSonars(options_));
  return report_;
}

}  // namespace s2s::inspect
