#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "s2s/calib/calibrator.h"
#include "s2s/mapper/survey_config.h"

namespace s2s::mapper {

/// Which part of which rawlog to calibrate from.
struct CalibrationRun {
  std::string rawlog;
  double from_s = 0;  ///< seconds from the first record; earlier ones are skipped
  double to_s = -1;   ///< seconds from the first record; negative: to the end
  int threads = 2;
  std::ostream* progress = nullptr;  ///< where progress goes; null: nowhere
};

struct SurveyCalibration {
  calib::CalibrationResult result;
  std::size_t pings = 0;
  std::vector<std::string> warnings;
};

/// Drives the LiDAR's part of the pipeline over a rawlog for the trajectory, reduces the pings to echoes, and estimates
/// the sonars' mountings, time offsets and the sound speed.
/// @throws core::InputError if there is no LiDAR, not both sonars, or too little of the seabed
SurveyCalibration calibrateSurvey(const CalibrationRun& run, const SurveyConfig& config);

}  // namespace s2s::mapper
