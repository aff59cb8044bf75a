#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::sonar {

/// The steps a preprocessing chain is made of (paper, section "Sonar Image Pre-Processing").
enum class PreprocessStep {
  RowQuantile,    ///< subtracts each range row's quantile, clamped at 0: evens out gain steps along range
  RowMean,        ///< subtracts each range row's mean, clamped at 0
  CenterRemoval,  ///< clears weak pixels of the beams around the central one
  OtsuMask,       ///< clears all pixels not above Otsu's threshold of the whole image
  Normalise,      ///< stretches to 0..255 and converts to 8 bit
  Opening,        ///< morphological opening: clears what is thinner than the kernel
  Median          ///< square median filter
};

/// An ordered list of steps and their parameters; a device is described by its options, nothing is compiled in.
/// The defaults are the paper's chain of the Oculus; `blueViewPreprocess` gives that of the BlueView.
struct PreprocessOptions {
  std::vector<PreprocessStep> steps = {PreprocessStep::RowQuantile, PreprocessStep::OtsuMask, PreprocessStep::Normalise,
                                       PreprocessStep::Opening};
  double rowQuantile = 0.10;
  /// Beams within this angle of the central beam are cleaned; the paper gives 10 degrees.
  double centerHalfWidth_rad = 10.0 * M_PI / 180.0;
  /// Pixels below this share of the image's strongest one are cleared there; the paper gives no value.
  double centerLevel = 0.2;
  /// Quantile of the non-zero pixels that becomes 255. The paper normalises without saying to what; the maximum (1)
  /// lets one glint, a wall square to the beam, darken the bed of the whole ping.
  double normaliseQuantile = 0.999;
  int openingBins = 3;   ///< kernel height along range; tall, because the noise spans several beams
  int openingBeams = 1;  ///< kernel width
  int medianSize = 3;
};

/// Row mean, weak pixels within +-10 degrees, normalise, 3 x 3 median: the paper's chain of the BlueView.
PreprocessOptions blueViewPreprocess();

/// Image after one step, for inspection; 8 bit, or 32-bit float before `Normalise` of a device with more than 8 bit.
struct PreprocessStage {
  std::string name;
  cv::Mat image;
};

/// Turns a ping into the 8-bit image that all later stages read.
class Preprocessor {
 public:
  /// @throws core::ConfigError if a kernel size is even or a share is not within 0..1
  explicit Preprocessor(const PreprocessOptions& options = {});

  /// CV_8U, rows = range bins (near to far), columns = beams in the ping's order. A chain without `Normalise` ends
  /// with a linear scaling of the device's full range to 0..255. An empty ping gives an empty image.
  /// @param stages if given, the image after each step is appended to it
  cv::Mat process(const obs::CObservationImagingSonar& ping, std::vector<PreprocessStage>* stages = nullptr) const;

  const PreprocessOptions& options() const { return options_; }

 private:
  void apply(PreprocessStep step, const obs::CObservationImagingSonar& ping, cv::Mat& image) const;

  PreprocessOptions options_;
};

/// "row_quantile", "otsu_mask", ...: the words used in INI files and picture names.
const char* stepName(PreprocessStep step);
/// All steps, in the order of the enum.
const std::vector<PreprocessStep>& allPreprocessSteps();

}  // namespace s2s::sonar
