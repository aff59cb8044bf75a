#pragma once

#include <mrpt/obs/CObservationPointCloud.h>

#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/obs/sweep_projector.h"
#include "s2s/odometry/options.h"
#include "s2s/odometry/scan.h"

namespace s2s::odometry {

/// Makes scans for the odometry out of observations. Of an organised sweep it looks at every n-th row and column only,
/// with a phase that moves from sweep to sweep so that all beams get their turn; so most pixels are never converted.
class ScanMaker {
 public:
  explicit ScanMaker(const ScanOptions& options) : options_(options) {}

  /// @throws core::InputError if the sweep contradicts itself
  Scan fromSweep(const obs::CObservationLidarSweep& sweep);

  /// A cloud has no times per point; an absent or empty one gives an empty scan.
  Scan fromCloud(const mrpt::obs::CObservationPointCloud& cloud);

 private:
  ScanOptions options_;
  obs::SweepProjector projector_;
  std::size_t scanCount_ = 0;  // chooses the phase
};

}  // namespace s2s::odometry
