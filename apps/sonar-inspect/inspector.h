#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "ping_source.h"
#include "s2s/sonar/options_table.h"

namespace s2s::inspect {

/// Writes a picture of each stage of the sonar chain into a folder.
class Inspector {
 public:
  Inspector(const sonar::SonarOptions& options, std::string folder);

  /// Every stage of one sonar: preprocessing step by step, leading edge. @param name begins the pictures' names
  void inspectDevice(const std::string& name, const sonar::SonarDevice& device,
                     const obs::CObservationImagingSonar& ping);

  /// Overlap, features, clusters, matches and points of a pair.
  void inspectPair(const obs::CObservationImagingSonar& h, const obs::CObservationImagingSonar& v);

  /// Whatever of the above the pings allow; returns a text about what was found.
  std::string inspect(const PingPair& pings);

  std::size_t pictureCount() const { return pictures_; }

 private:
  void write(const std::string& name, const cv::Mat& picture);
  void drawFeatures(const std::string& name, const sonar::ProcessedPing& ping, const sonar::Overlap& overlap,
                    const std::vector<sonar::Feature>& features);
  void drawMatches(const sonar::ProcessedPing& h, const sonar::ProcessedPing& v, const sonar::StereoTrace& trace);
  void drawPoints(const sonar::StereoResult& result);

  sonar::SonarOptions options_;
  sonar::SonarStereo stereo_;
  std::string folder_;
  std::string report_;
  std::size_t pictures_ = 0;
};

}  // namespace s2s::inspect
