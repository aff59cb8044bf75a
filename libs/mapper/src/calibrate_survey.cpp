#include "s2s/mapper/calibrate_survey.h"

#include "calibration_gatherer.h"
#include "s2s/core/progress.h"
#include "survey_reading.h"

namespace s2s::mapper {

SurveyCalibration calibrateSurvey(const CalibrationRun& run, const SurveyConfig& config) {
  obs::RawlogReader reader(run.rawlog);
  CalibrationGatherer gatherer(config, run.threads);
  readRecords({run.from_s, run.to_s, "Reading survey", run.progress}, reader, gatherer.faults(),
              [&gatherer](const auto& record, const std::string& where) { gatherer.push(record, where); });
  gatherer.finish(run.rawlog);
  SurveyCalibration calibration;
  const calib::CalibrationEvidence evidence = gatherer.evidence();
  calibration.pings = evidence.pings.size();
  calibration.warnings = gatherer.faults().lines();
  core::Progress progress(run.progress, "Calibrating", 0, "rounds");
  auto options = config.calibration;
  options.threads = run.threads;
  calibration.result = calib::calibrate(gatherer.nominal(), evidence, options, [&progress](int done, int total) {
    progress.setTotal(total);
    progress.update(done);
  });
  return calibration;
}

}  // namespace s2s::mapper
