#include "s2s/sonar/features.h"

#include <algorithm>
#include <cmath>

namespace s2s::sonar {

namespace {

float bilinear(const cv::Mat& image, double bin, double beam) {
  // Of a single beam the neighbours are nowhere: NaN fails the comparison.
  if (!(bin >= 0 && beam >= 0 && bin <= image.rows - 1 && beam <= image.cols - 1)) return 0;
  const int r = std::min(static_cast<int>(bin), std::max(0, image.rows - 2));
  const int c = std::min(static_cast<int>(beam), std::max(0, image.cols - 2));
  const auto u = static_cast<float>(bin - r), w = static_cast<float>(beam - c);
  const auto* near = image.ptr<std::uint8_t>(r) + c;
  const auto* far = image.ptr<std::uint8_t>(std::min(r + 1, image.rows - 1)) + c;
  const int right = image.cols > 1 ? 1 : 0;
  return (1 - u) * ((1 - w) * static_cast<float>(near[0]) + w * static_cast<float>(near[right])) +
         u * ((1 - w) * static_cast<float>(far[0]) + w * static_cast<float>(far[right]));
}

/// A contiguous run of detections in one range row, with its centre of intensity.
struct Run {
  int first = 0, end = 0;
  double bearing_rad = 0;
};

Run runFrom(const std::uint8_t* detected, const std::uint8_t* pixels, const PingGeometry& geometry, int first,
            int end) {
  Run run{first, first, 0};
  double weight = 0, sum = 0;
  for (; run.end < end && detected[run.end] != 0; ++run.end) {
    weight += pixels[run.end];
    sum += pixels[run.end] * geometry.bearings_rad[static_cast<std::size_t>(run.end)];
  }
  run.bearing_rad = weight > 0 ? sum / weight : geometry.bearings_rad[static_cast<std::size_t>(first)];
  return run;
}

class Extractor {
 public:
  Extractor(const cv::Mat& image, const cv::Mat& detections, const PingGeometry& geometry, const Overlap& overlap,
            const core::Isometry& T_h_sonar, const FeatureOptions& options)
      : image_(image),
        detections_(detections),
        geometry_(geometry),
        overlap_(overlap),
        T_(T_h_sonar),
        options_(options) {
    for (const double bearing : geometry.bearings_rad)
      directions_.push_back(pointAt({1.0, bearing, 0}, geometry.bearingModel));
  }

  std::vector<Feature> run() {
    const ImageRegion& region = overlap_.region;
    for (int bin = region.firstBin; bin < region.endBin; ++bin)
      for (int beam = region.firstBeam; beam < region.endBeam;) {
        if (detections_.at<std::uint8_t>(bin, beam) == 0) {
          ++beam;
          continue;
        }
        const Run run =
            runFrom(detections_.ptr<std::uint8_t>(bin), image_.ptr<std::uint8_t>(bin), geometry_, beam, region.endBeam);
        addRun(bin, run);
        beam = run.end;
      }
    return std::move(features_);
  }

 private:
  double width(const Run& run) const {
    return std::abs(geometry_.bearings_rad[static_cast<std::size_t>(run.end - 1)] -
                    geometry_.bearings_rad[static_cast<std::size_t>(run.first)]);
  }

  void addRun(int bin, const Run& run) {
    // A run that the trimmed region cuts off has no centre.
    const bool whole = run.first > overlap_.region.firstBeam && run.end < overlap_.region.endBeam;
    const double width_rad = width(run);
    const bool thin = whole && width_rad <= options_.maxRunWidth_rad;
    const double sigma_rad =
        thin ? std::hypot(options_.bearingSigma_rad, width_rad / std::sqrt(12.0)) : options_.bearingSigma_rad;
    for (int beam = run.first; beam < run.end; ++beam) {
      if (!overlap_.contains(beam, bin)) continue;
      Feature f;
      f.bin = static_cast<std::uint32_t>(bin);
      f.beam = static_cast<std::uint32_t>(beam);
      f.range_m = geometry_.range_m(bin);
      f.beamBearing_rad = geometry_.bearings_rad[f.beam];
      f.bearing_rad = thin ? run.bearing_rad : f.beamBearing_rad;
      f.bearingSigma_rad = sigma_rad;
      f.p_h = T_ * (f.range_m * directions_[f.beam]);
      f.intensity = static_cast<float>(image_.at<std::uint8_t>(bin, beam));
      addContext(f);
      features_.push_back(f);
    }
  }

  /// Neighbours one step away along x and y of the Cartesian image, looked up in the polar one to first order: along x
  /// the range changes by cos(b) step and the bearing by -sin(b) step / r, along y by sin(b) and cos(b) / r.
  void addContext(Feature& f) const {
    const auto beam = static_cast<int>(f.beam);
    const double c = directions_[f.beam].x(), s = directions_[f.beam].y();
    const int next = std::min(beam + 1, static_cast<int>(geometry_.beamCount()) - 1), previous = std::max(beam - 1, 0);
    const double spacing_rad = (geometry_.bearings_rad[static_cast<std::size_t>(next)] -
                                geometry_.bearings_rad[static_cast<std::size_t>(previous)]) /
                               std::max(1, next - previous);
    const double bins = options_.contextStep_m / geometry_.rangeResolution_m;
    const double beams = options_.contextStep_m / (f.range_m * spacing_rad);
    const auto mean = [&](double dBin, double dBeam) {
      return (f.intensity + bilinear(image_, f.bin + dBin, f.beam + dBeam) +
              bilinear(image_, f.bin - dBin, f.beam - dBeam)) /
             3.0f;
    };
    f.contextX = mean(c * bins, -s * beams);
    f.contextY = mean(s * bins, c * beams);
  }

  const cv::Mat& image_;
  const cv::Mat& detections_;
  const PingGeometry& geometry_;
  const Overlap& overlap_;
  core::Isometry T_;
  const FeatureOptions& options_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<Feature> features_;
};

}  // namespace

std::vector<Feature> extractFeatures(const cv::Mat& image, const cv::Mat& detections, const PingGeometry& geometry,
                                     const Overlap& overlap, const core::Isometry& T_h_sonar,
                                     const FeatureOptions& options) {
  return Extractor(image, detections, geometry, overlap, T_h_sonar, options).run();
}

float sampleAt(const cv::Mat& image, const PingGeometry& geometry, const Eigen::Vector2d& p) {
  return bilinear(image, geometry.binAt(p.norm()), geometry.beamAt(std::atan2(p.y(), p.x())));
}

}  // namespace s2s::sonar
