#include "s2s/mapper/gnss_reader.h"

#include <mrpt/topography/conversions.h>

#include <cmath>

namespace s2s::mapper {

namespace {

mrpt::topography::TGeodeticCoords toMrpt(const GeodeticPosition& p) {
  return {p.latitude_deg, p.longitude_deg, p.height_m};
}

/// Nothing for a fix that is none: invalid, dead reckoned, typed in or simulated by the receiver.
std::optional<double> sigmaOf(int fixQuality, const GnssReaderOptions& o) {
  switch (fixQuality) {
    case 1:  // autonomous
    case 3:  // PPS
      return o.sigmaSingle_m;
    case 2:
      return o.sigmaDifferential_m;
    case 4:
      return o.sigmaFixed_m;
    case 5:
      return o.sigmaFloat_m;
    default:
      return std::nullopt;
  }
}

}  // namespace

core::OptionTable optionTable(GnssReaderOptions& o) {
  core::OptionTable table;
  table
      .add("sigma_single_m", o.sigmaSingle_m, "standard deviation of an autonomous fix at an HDOP of 1",
           core::positive())
      .add("sigma_differential_m", o.sigmaDifferential_m, "of a differential fix", core::positive())
      .add("sigma_float_m", o.sigmaFloat_m, "of a real-time kinematic fix with float ambiguities", core::positive())
      .add("sigma_fixed_m", o.sigmaFixed_m, "of a real-time kinematic fix with fixed ambiguities", core::positive())
      .add("height_factor", o.heightFactor, "a height is so many times worse", core::positive());
  return table;
}

std::optional<graph::GnssFix> GnssReader::read(const mrpt::obs::CObservationGPS& observation) {
  using Gga = mrpt::obs::gnss::Message_NMEA_GGA;
  if (!observation.hasMsgClass<Gga>()) return std::nullopt;
  const auto& f = observation.getMsgByClass<Gga>().fields;
  const auto sigma_m = sigmaOf(f.fix_quality, options_);
  const GeodeticPosition position{f.latitude_degrees, f.longitude_degrees, f.altitude_meters};
  const bool plausible = std::abs(position.latitude_deg) <= 90 && std::abs(position.longitude_deg) <= 180 &&
                         std::isfinite(position.height_m);
  if (!sigma_m || !plausible) return std::nullopt;
  if (!origin_) origin_ = position;
  mrpt::math::TPoint3D p_enu;
  mrpt::topography::geodeticToENU_WGS84(toMrpt(position), p_enu, toMrpt(*origin_));

  graph::GnssFix fix;
  fix.time = core::fromMrptTime(observation.timestamp);
  fix.p_enu = Eigen::Vector3d(p_enu.x, p_enu.y, p_enu.z);
  const double hdop = f.thereis_HDOP && f.HDOP > 0 ? std::max(0.5, static_cast<double>(f.HDOP)) : 1.0;
  fix.sigma_m = *sigma_m * hdop * Eigen::Vector3d(1, 1, options_.heightFactor);
  fix.p_vehicle_antenna = core::toIsometry(observation.sensorPose).translation();
  return fix;
}

GeodeticPosition toGeodetic(const Eigen::Vector3d& p_enu, const GeodeticPosition& origin) {
  // By iterating the exact way there, since MRPT's way back (geocentricToGeodetic) is off by decimetres in height. A
  // step with rough degrees leaves a hundredth of the error at most.
  constexpr double kMetresPerDegree = 111200;
  GeodeticPosition position = origin;
  for (int step = 0; step < 8; ++step) {
    mrpt::math::TPoint3D p;
    mrpt::topography::geodeticToENU_WGS84(toMrpt(position), p, toMrpt(origin));
    position.latitude_deg += (p_enu.y() - p.y) / kMetresPerDegree;
    position.longitude_deg += (p_enu.x() - p.x) / (kMetresPerDegree * std::cos(origin.latitude_deg * M_PI / 180));
    position.height_m += p_enu.z() - p.z;
  }
  return position;
}

}  // namespace s2s::mapper
