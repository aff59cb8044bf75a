#pragma once

#include <map>

#include "s2s/calib/evidence.h"
#include "s2s/mapper/backend_stage.h"
#include "s2s/mapper/odometry_stage.h"
#include "s2s/mapper/sensor_router.h"
#include "s2s/mapper/survey_config.h"
#include "s2s/mapper/worker.h"
#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::mapper {

/// Turns a survey into evidence for the calibration: LiDAR and IMU go through odometry and graph, pings become
/// echoes.
class CalibrationGatherer {
 public:
  CalibrationGatherer(const SurveyConfig& config, int threads);

  void push(const mrpt::obs::CObservation::Ptr& observation, const std::string& where);
  /// @throws core::InputError if there is no LiDAR or not both sonars
  void finish(const std::string& rawlog);

  const calib::CalibrationState& nominal() const { return nominal_; }
  /// To be called after `finish`, once.
  calib::CalibrationEvidence evidence();
  FaultLog& faults() { return faults_; }

 private:
  void onOdometry(const OdometryUpdate& update);
  void addPing(Role role, const obs::CObservationImagingSonar& ping);
  void addHorizontal(const obs::CObservationImagingSonar& ping, calib::PingEchoes& echoes);
  void addVertical(const obs::CObservationImagingSonar& ping, calib::PingEchoes& echoes);
  /// Takes what is nominal of a sonar from its first usable ping and the configuration.
  void describe(calib::SonarId id, const obs::CObservationImagingSonar& ping);
  core::Trajectory trajectory() const;
  calib::WallFinder walls(double waterHeight_m) const;

  const SurveyConfig& config_;
  const MapperOptions mapperOptions_;
  FaultLog faults_;
  SensorRouter router_;
  BackendStage backend_;
  core::Trajectory path_;  // T_odom_vehicle
  OdometryStage odometry_;
  Worker odometryWorker_;
  sonar::SonarDevice horizontal_, vertical_;
  calib::CalibrationState nominal_;
  std::map<calib::SonarId, bool> described_;
  std::vector<calib::PingEchoes> pings_;
  std::vector<calib::TexturePing> texture_;
  std::vector<calib::AperturePing> aperture_;
  int horizontalPings_ = 0;
  std::vector<calib::MirrorTrace> mirror_;
};

}  // namespace s2s::mapper
