#include "s2s/sim/gnss_model.h"

#include <cmath>
#include <ctime>

namespace s2s::sim {

using Eigen::Vector3d;

namespace {

constexpr double kSemiMajor_m = 6378137.0, kFlattening = 1 / 298.257223563;
constexpr double kEccentricity2 = kFlattening * (2 - kFlattening);

struct Geodetic {
  double latitude_deg, longitude_deg, height_m;
};

/// East-north-up offsets to geodetic coordinates with the ellipsoid's radii of curvature at the origin; exact to a
/// millimetre within a kilometre.
Geodetic toGeodetic(const GnssOptions& o, const Vector3d& p_enu_m) {
  const double latitude = o.originLatitude_deg * M_PI / 180, s = std::sin(latitude);
  const double w = std::sqrt(1 - kEccentricity2 * s * s);
  const double meridian = kSemiMajor_m * (1 - kEccentricity2) / (w * w * w), prime = kSemiMajor_m / w;
  return {o.originLatitude_deg + p_enu_m.y() / meridian * 180 / M_PI,
          o.originLongitude_deg + p_enu_m.x() / (prime * std::cos(latitude)) * 180 / M_PI,
          o.originHeight_m + p_enu_m.z()};
}

}  // namespace

GnssModel::GnssModel(const GnssOptions& options, std::uint64_t seed) : options_(options), random_(seed, 0x676e7373) {
  for (int axis = 0; axis < 3; ++axis) wander_m_[axis] = options.wander_m * random_.normal();
}

mrpt::obs::CObservationGPS::Ptr GnssModel::fix(const VesselMotion& motion, double t_s, core::TimeNs time,
                                               const Vector3d& offset_world_m) {
  const GnssOptions& o = options_;
  const double keep = std::exp(-1 / (o.rate_hz * o.wanderTime_s));  // first-order Gauss-Markov process
  Vector3d error;
  for (int axis = 0; axis < 3; ++axis) {
    wander_m_[axis] = keep * wander_m_[axis] + std::sqrt(1 - keep * keep) * o.wander_m * random_.normal();
    error[axis] = (axis == 2 ? 2 : 1) * (wander_m_[axis] + o.noise_m * random_.normal());
  }
  const Geodetic g = toGeodetic(o, motion.pose(t_s) * o.T_vehicle_antenna.translation() + error + offset_world_m);
  auto gps = mrpt::obs::CObservationGPS::Create();
  gps->timestamp = gps->originalReceivedTimestamp = core::toMrptTime(time);
  gps->sensorLabel = o.label;
  gps->sensorPose = core::toPose(o.T_vehicle_antenna);
  mrpt::obs::gnss::Message_NMEA_GGA gga;
  const std::int64_t secondOfDay = time / core::kNsPerSecond % 86400;
  gga.fields.UTCTime.hour = static_cast<std::uint8_t>(secondOfDay / 3600);
  gga.fields.UTCTime.minute = static_cast<std::uint8_t>(secondOfDay / 60 % 60);
  gga.fields.UTCTime.sec =
      static_cast<double>(secondOfDay % 60) + 1e-9 * static_cast<double>(time % core::kNsPerSecond);
  gga.fields.latitude_degrees = g.latitude_deg;
  gga.fields.longitude_degrees = g.longitude_deg;
  gga.fields.altitude_meters = g.height_m;
  gga.fields.fix_quality = 1;
  gga.fields.satellitesUsed = 9;
  gga.fields.HDOP = 1.1f;
  gga.fields.thereis_HDOP = true;
  gps->setMsg(gga);
  return gps;
}

}  // namespace s2s::sim
