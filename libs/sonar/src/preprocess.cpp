#include "s2s/sonar/preprocess.h"

#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "preprocess_steps.h"
#include "s2s/core/error.h"

namespace s2s::sonar {

namespace {

/// The samples as an image: 8-bit devices stay 8 bit, all others become float.
cv::Mat imageOf(const obs::CObservationImagingSonar& ping) {
  const auto rows = static_cast<int>(ping.rangeCount), columns = static_cast<int>(ping.beamCount);
  if (ping.bytesPerSample == 1) {
    cv::Mat image(rows, columns, CV_8U);
    std::memcpy(image.data, ping.samples.data(), ping.samples.size());
    return image;
  }
  cv::Mat image(rows, columns, CV_32F);
  for (std::size_t bin = 0; bin < ping.rangeCount; ++bin)
    for (std::size_t beam = 0; beam < ping.beamCount; ++beam)
      image.at<float>(static_cast<int>(bin), static_cast<int>(beam)) = static_cast<float>(ping.sample(bin, beam));
  return image;
}

std::vector<char> centralBeams(const obs::CObservationImagingSonar& ping, double halfWidth_rad) {
  std::vector<char> central(ping.bearings_rad.size());
  for (std::size_t beam = 0; beam < central.size(); ++beam)
    central[beam] = std::abs(static_cast<double>(ping.bearings_rad[beam])) <= halfWidth_rad ? 1 : 0;
  return central;
}

void require(bool good, const std::string& what, const std::string& remedy) {
  if (!good) throw core::ConfigError(what, "sonar preprocessing", remedy);
}

}  // namespace

PreprocessOptions blueViewPreprocess() {
  PreprocessOptions options;
  options.steps = {PreprocessStep::RowMean, PreprocessStep::CenterRemoval, PreprocessStep::Normalise,
                   PreprocessStep::Median};
  return options;
}

const std::vector<PreprocessStep>& allPreprocessSteps() {
  static const std::vector<PreprocessStep> kSteps = {
      PreprocessStep::RowQuantile, PreprocessStep::RowMean, PreprocessStep::CenterRemoval, PreprocessStep::OtsuMask,
      PreprocessStep::Normalise,   PreprocessStep::Opening, PreprocessStep::Median};
  return kSteps;
}

const char* stepName(PreprocessStep step) {
  switch (step) {
    case PreprocessStep::RowQuantile:
      return "row_quantile";
    case PreprocessStep::RowMean:
      return "row_mean";
    case PreprocessStep::CenterRemoval:
      return "center_removal";
    case PreprocessStep::OtsuMask:
      return "otsu_mask";
    case PreprocessStep::Normalise:
      return "normalise";
    case PreprocessStep::Opening:
      return "opening";
    case PreprocessStep::Median:
      return "median";
  }
  return "?";
}

Preprocessor::Preprocessor(const PreprocessOptions& options) : options_(options) {
  const auto isShare = [](double value) { return value >= 0 && value <= 1; };
  require(isShare(options_.rowQuantile), "the row quantile is not within 0..1", "give e.g. 0.1");
  require(isShare(options_.centerLevel), "the centre level is not within 0..1", "give e.g. 0.2");
  require(isShare(options_.normaliseQuantile), "the normalising quantile is not within 0..1", "give e.g. 1");
  require(options_.openingBins >= 1 && options_.openingBeams >= 1, "the opening kernel is empty", "give 3 and 1");
  require(options_.medianSize == 3 || options_.medianSize == 5, "the median size is neither 3 nor 5", "give 3 or 5");
}

void Preprocessor::apply(PreprocessStep step, const obs::CObservationImagingSonar& ping, cv::Mat& image) const {
  switch (step) {
    case PreprocessStep::RowQuantile:
      steps::subtractRowQuantile(image, options_.rowQuantile);
      break;
    case PreprocessStep::RowMean:
      steps::subtractRowMean(image);
      break;
    case PreprocessStep::CenterRemoval:
      steps::clearWeakPixels(image, centralBeams(ping, options_.centerHalfWidth_rad), options_.centerLevel);
      break;
    case PreprocessStep::OtsuMask:
      steps::clearUpTo(image, steps::otsuThreshold(image));
      break;
    case PreprocessStep::Normalise:
      steps::normaliseTo8Bit(image, options_.normaliseQuantile);
      break;
    case PreprocessStep::Opening:
      cv::morphologyEx(image, image, cv::MORPH_OPEN, cv::Mat::ones(options_.openingBins, options_.openingBeams, CV_8U));
      break;
    case PreprocessStep::Median: {
      cv::Mat filtered;
      cv::medianBlur(image, filtered, options_.medianSize);
      image = filtered;
    } break;
  }
}

cv::Mat Preprocessor::process(const obs::CObservationImagingSonar& ping, std::vector<PreprocessStage>* stages) const {
  ping.checkConsistent();
  if (ping.rangeCount == 0 || ping.beamCount == 0) return {};
  cv::Mat image = imageOf(ping);
  if (stages != nullptr) stages->push_back({"raw", image.clone()});
  for (const PreprocessStep step : options_.steps) {
    apply(step, ping, image);
    if (stages != nullptr) stages->push_back({stepName(step), image.clone()});
  }
  if (image.depth() != CV_8U) {
    cv::Mat out;
    image.convertTo(out, CV_8U, 255.0 / ping.maxSample());
    image = out;
  }
  return image;
}

}  // namespace s2s::sonar
