#pragma once

#include <memory>
#include <string>
#include <vector>

#include "s2s/core/trajectory.h"
#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/odometry/lidar_inertial_odometry.h"
#include "s2s/odometry/scan_maker.h"

namespace s2s::bench {

/// An odometry that takes part in a comparison, with the processor time it needs.
class Contestant {
 public:
  explicit Contestant(std::string name) : name_(std::move(name)) {}
  virtual ~Contestant() = default;

  const std::string& name() const { return name_; }
  void imu(const odometry::ImuSample& sample);
  void sweep(const obs::CObservationLidarSweep& sweep);
  /// Stereo points of the sonars, for those that can use them.
  virtual void acoustic(const odometry::AcousticScan&) {}
  void finish();

  /// A pose for every sweep that has one.
  const std::vector<odometry::OdometryResult>& results() const { return results_; }
  /// Processor time of this thread for each sweep, with its IMU samples [s].
  const std::vector<double>& seconds() const { return seconds_; }

 protected:
  virtual void takeImu(const odometry::ImuSample& sample) = 0;
  virtual void takeSweep(const obs::CObservationLidarSweep& sweep) = 0;
  virtual void takeEnd() = 0;
  void keep(odometry::OdometryResult result);

 private:
  std::string name_;
  std::vector<odometry::OdometryResult> results_;
  std::vector<double> seconds_;
  double sinceSweep_s_ = 0;
};

/// Our odometry.
class OurOdometry : public Contestant {
 public:
  /// @param leastGap_s sweeps nearer to the last one taken than this are left out (0: every sweep is used)
  OurOdometry(std::string name, const odometry::OdometryOptions& options, double leastGap_s = 0);

  void acoustic(const odometry::AcousticScan& scan) override { odometry_.addAcoustic(scan); }
  /// T_from_to of the vehicle, as it moves at present.
  core::Isometry expectedMotion(core::TimeNs from, core::TimeNs to) const { return odometry_.expectedMotion(from, to); }

 protected:
  void takeImu(const odometry::ImuSample& sample) override;
  void takeSweep(const obs::CObservationLidarSweep& sweep) override;
  void takeEnd() override;

 private:
  void drain();
  odometry::ScanMaker maker_;
  odometry::LidarInertialOdometry odometry_;
  double leastGap_s_;
  core::TimeNs last_ = 0;
};

}  // namespace s2s::bench
