#pragma once

#include <opencv2/core.hpp>

#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/sonar/cfar.h"
#include "s2s/sonar/features.h"
#include "s2s/sonar/leading_edge.h"
#include "s2s/sonar/preprocess.h"

namespace s2s::sonar {

/// Everything that is set for one sonar: the chain of its stages.
struct DeviceOptions {
  PreprocessOptions preprocess;
  LeadingEdgeOptions leadingEdge;
  CfarOptions cfar;
  FeatureOptions features;
};

/// The paper's settings of the horizontal sonar (Oculus M750d) and of the vertical one (BlueView M900-2250-130-Mk2);
/// the former with a leading edge freed of the delay by speckle, and with ridges behind it.
DeviceOptions horizontalDefaults();
DeviceOptions verticalDefaults();

/// A ping made ready once for all that read it: line-scans and stereo.
struct ProcessedPing {
  cv::Mat image;  ///< CV_8U, rows = range bins, columns = beams
  PingGeometry geometry;
  LineScan lineScan;
};

/// Preprocessing and leading edge of one sonar. Holds no state between pings, so one may serve several threads.
class SonarDevice {
 public:
  /// @throws core::ConfigError if an option contradicts itself
  explicit SonarDevice(const DeviceOptions& options);

  /// @throws core::InputError if the ping contradicts itself
  ProcessedPing process(const obs::CObservationImagingSonar& ping) const;

  const DeviceOptions& options() const { return options_; }
  const Preprocessor& preprocessor() const { return preprocessor_; }
  const CfarDetector& cfar() const { return cfar_; }

 private:
  DeviceOptions options_;
  Preprocessor preprocessor_;
  CfarDetector cfar_;
};

}  // namespace s2s::sonar
