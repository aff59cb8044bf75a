#include "s2s/sim/sonar_model.h"

namespace s2s::sim {

SonarModel::SonarModel(const SonarOptions& options, const core::Isometry& T_vehicle_sensor, const Scene& scene,
                       const RayCaster& caster, std::uint64_t seed)
    : options_(options),
      T_vehicle_sensor_(T_vehicle_sensor),
      geometry_(options_),
      tracer_(options_, geometry_, scene, caster),
      beamFormer_(options_, geometry_),
      artefacts_(options_, geometry_, seed),
      receiver_(options_),
      seed_(seed) {}

SonarModel::PingPtr SonarModel::ping(const VesselMotion& motion, double t_s, core::TimeNs time, std::uint32_t number,
                                     PingTruth* truth) const {
  Random random(seed_, 1, number);
  EchoImage echo;
  tracer_.trace(motion.pose(t_s) * T_vehicle_sensor_, random, echo, truth ? &truth->returns : nullptr);
  std::vector<float> power;
  beamFormer_.form(echo, random.bits(), power);
  artefacts_.apply(power, t_s, random);
  if (truth) {
    truth->time = time;
    truth->pingId = number + 1;
  }

  auto ping = obs::CObservationImagingSonar::Create();
  ping->timestamp = core::toMrptTime(time);
  ping->sensorLabel = options_.label;
  ping->sensorModel = options_.model;
  ping->sensorPose = core::toPose(options_.T_vehicle_sensor);
  ping->beamCount = static_cast<std::uint32_t>(options_.beamCount);
  ping->rangeCount = static_cast<std::uint32_t>(options_.rangeCount);
  receiver_.quantize(power, ping->beamCount, ping->samples);
  for (const double b : geometry_.bearings_rad()) ping->bearings_rad.push_back(static_cast<float>(b));
  ping->rangeResolution_m = options_.maxRange_m / options_.rangeCount;
  ping->verticalAperture_rad = options_.aperture_rad;
  ping->bearingModel = options_.bearingModel;
  ping->soundSpeed_mps = options_.soundSpeedAssumed_mps;
  ping->frequency_hz = options_.frequency_hz;
  ping->pingId = number + 1;
  return ping;
}

}  // namespace s2s::sim
