#pragma once

#include "s2s/obs/CObservationImagingSonar.h"
#include "s2s/sim/ping_truth.h"
#include "s2s/sim/sonar_artefacts.h"
#include "s2s/sim/sonar_receiver.h"
#include "s2s/sim/vessel_motion.h"

namespace s2s::sim {

/// A simulated imaging sonar: casting, beam forming, artefacts and receiver composed. Safe to use from many threads.
class SonarModel {
 public:
  using PingPtr = obs::CObservationImagingSonar::Ptr;

  /// `scene` and `caster` must outlive the model.
  /// @param T_vehicle_sensor the true mounting; the options hold the nominal one, which the pings carry
  SonarModel(const SonarOptions& options, const core::Isometry& T_vehicle_sensor, const Scene& scene,
             const RayCaster& caster, std::uint64_t seed);
  SonarModel(const SonarModel&) = delete;
  SonarModel& operator=(const SonarModel&) = delete;

  /// The ping with the given number, transmitted at t_s of the motion's clock. What it holds depends on number and
  /// seed only, not on the pings before it.
  /// @param truth if not null, gets the points behind the strongest returns
  PingPtr ping(const VesselMotion& motion, double t_s, core::TimeNs time, std::uint32_t number,
               PingTruth* truth = nullptr) const;

  const SonarGeometry& geometry() const { return geometry_; }

 private:
  SonarOptions options_;
  core::Isometry T_vehicle_sensor_;
  SonarGeometry geometry_;
  EchoTracer tracer_;
  BeamFormer beamFormer_;
  ArtefactModel artefacts_;
  SonarReceiver receiver_;
  std::uint64_t seed_;
};

}  // namespace s2s::sim
