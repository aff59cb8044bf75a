#include "s2s/obs/CObservationLidarSweep.h"

#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "packed_vector.h"
#include "s2s/core/error.h"

using namespace s2s::obs;  // the macro below wants the bare class name
IMPLEMENTS_SERIALIZABLE(CObservationLidarSweep, mrpt::obs::CObservation, s2s::obs)

namespace s2s::obs {

std::uint8_t CObservationLidarSweep::serializeGetVersion() const { return 0; }

void CObservationLidarSweep::serializeTo(mrpt::serialization::CArchive& out) const {
  out << timestamp << sensorLabel << sensorModel << sensorPose;
  out << rowCount << columnCount << rangeResolution_m << minRange_m << maxRange_m;
  out << static_cast<std::uint8_t>(echoes.size());
  for (const Echo& echo : echoes) {
    packed::write(out, echo.range);
    packed::write(out, echo.reflectivity);
    packed::write(out, echo.signal);
    packed::write(out, echo.flags);
  }
  packed::write(out, nearInfrared);
  packed::write(out, beamAltitude_rad);
  packed::write(out, beamAzimuth_rad);
  out << beamOriginOffset_m << beamOriginHeight_m << T_sensor_lidar;
  packed::write(out, columnAzimuth_rad);
  packed::write(out, columnTime_ns);
  packed::write(out, rowTime_ns);
  packed::write(out, columnValid);
  out << deviceTime_s << frameId;
}

void CObservationLidarSweep::serializeFrom(mrpt::serialization::CArchive& in, std::uint8_t version) {
  switch (version) {
    case 0: {
      in >> timestamp >> sensorLabel >> sensorModel >> sensorPose;
      in >> rowCount >> columnCount >> rangeResolution_m >> minRange_m >> maxRange_m;
      echoes.resize(in.ReadAs<std::uint8_t>());
      for (Echo& echo : echoes) {
        packed::read(in, echo.range, "range");
        packed::read(in, echo.reflectivity, "reflectivity");
        packed::read(in, echo.signal, "signal");
        packed::read(in, echo.flags, "flags");
      }
      packed::read(in, nearInfrared, "nearInfrared");
      packed::read(in, beamAltitude_rad, "beamAltitude_rad");
      packed::read(in, beamAzimuth_rad, "beamAzimuth_rad");
      in >> beamOriginOffset_m >> beamOriginHeight_m >> T_sensor_lidar;
      packed::read(in, columnAzimuth_rad, "columnAzimuth_rad");
      packed::read(in, columnTime_ns, "columnTime_ns");
      packed::read(in, rowTime_ns, "rowTime_ns");
      packed::read(in, columnValid, "columnValid");
      in >> deviceTime_s >> frameId;
    } break;
    default:
      MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  }
  checkConsistent();
}

std::int32_t CObservationLidarSweep::pixelTime_ns(std::size_t row, std::size_t column) const {
  return (columnTime_ns.empty() ? 0 : columnTime_ns[column]) + (rowTime_ns.empty() ? 0 : rowTime_ns[row]);
}

double CObservationLidarSweep::duration_s() const {
  const auto span_ns = [](const std::vector<std::int32_t>& times_ns) -> std::int64_t {
    if (times_ns.empty()) return 0;
    const auto [first, last] = std::minmax_element(times_ns.begin(), times_ns.end());
    return std::int64_t{*last} - *first;
  };
  return 1e-9 * static_cast<double>(span_ns(columnTime_ns) + span_ns(rowTime_ns));
}

std::size_t CObservationLidarSweep::returnCount() const {
  if (echoes.empty()) return 0;
  const auto& range = echoes.front().range;
  return range.size() - static_cast<std::size_t>(std::count(range.begin(), range.end(), 0u));
}

void CObservationLidarSweep::checkConsistent() const {
  const auto requireSize = [this](std::size_t size, std::size_t expected, bool mayBeEmpty, const char* field) {
    if (size == expected || (mayBeEmpty && size == 0)) return;
    throw core::InputError(std::string(field) + " has " + std::to_string(size) + " values, expected " +
                               std::to_string(expected) + " for " + std::to_string(rowCount) + " rows x " +
                               std::to_string(columnCount) + " columns",
                           "LiDAR sweep of '" + sensorLabel + "'", "the record is damaged or its writer is at fault");
  };
  if (echoes.empty() || echoes.size() > 8 || !(rangeResolution_m > 0))
    throw core::InputError("no echoes, too many, or no range resolution", "LiDAR sweep of '" + sensorLabel + "'",
                           "the record is damaged or its writer is at fault");
  for (const Echo& echo : echoes) {
    requireSize(echo.range.size(), pixelCount(), false, "range");
    requireSize(echo.reflectivity.size(), pixelCount(), true, "reflectivity");
    requireSize(echo.signal.size(), pixelCount(), true, "signal");
    requireSize(echo.flags.size(), pixelCount(), true, "flags");
  }
  requireSize(nearInfrared.size(), pixelCount(), true, "nearInfrared");
  requireSize(beamAltitude_rad.size(), rowCount, false, "beamAltitude_rad");
  requireSize(beamAzimuth_rad.size(), rowCount, true, "beamAzimuth_rad");
  requireSize(columnAzimuth_rad.size(), columnCount, false, "columnAzimuth_rad");
  requireSize(columnTime_ns.size(), columnCount, true, "columnTime_ns");
  requireSize(rowTime_ns.size(), rowCount, true, "rowTime_ns");
  requireSize(columnValid.size(), columnCount, true, "columnValid");
}

void CObservationLidarSweep::getDescriptionAsText(std::ostream& o) const {
  CObservation::getDescriptionAsText(o);
  const std::size_t valid = columnValid.empty()
                                ? columnCount
                                : static_cast<std::size_t>(std::count_if(columnValid.begin(), columnValid.end(),
                                                                         [](std::uint8_t v) { return v != 0; }));
  o << "LiDAR sweep" << (sensorModel.empty() ? "" : " of a " + sensorModel) << "\n";
  o << "  image:            " << rowCount << " beams x " << columnCount << " columns (" << valid << " received), "
    << echoes.size() << " echo(es)\n";
  o << "  returns:          " << returnCount() << " of " << pixelCount() << "\n";
  o << "  range resolution: " << 1e3 * rangeResolution_m << " mm\n";
  o << "  duration:         " << 1e3 * duration_s() << " ms from the first to the last pixel\n";
  if (!beamAltitude_rad.empty())
    o << "  beam altitudes:   " << beamAltitude_rad.front() * 180 / M_PI << " to "
      << beamAltitude_rad.back() * 180 / M_PI << " deg\n";
  o << "  layers:           range" << (!echoes.empty() && !echoes[0].reflectivity.empty() ? ", reflectivity" : "")
    << (!echoes.empty() && !echoes[0].signal.empty() ? ", signal" : "")
    << (!nearInfrared.empty() ? ", near infrared" : "") << "\n";
  o << "  frame number:     " << frameId << "\n";
  o << "  device clock:     " << (deviceTime_s < 0 ? std::string("none") : std::to_string(deviceTime_s) + " s") << "\n";
  o << "  sensor pose on the vehicle: " << sensorPose << "\n";
}

std::string CObservationLidarSweep::exportTxtHeader() const {
  return "rowCount columnCount duration_s returnCount mean_range_m[row 0..rowCount-1, 0 if the row has no return]";
}

std::string CObservationLidarSweep::exportTxtDataRow() const {
  std::string text = mrpt::format("%u %u %.6f %zu", rowCount, columnCount, duration_s(), returnCount());
  for (std::size_t row = 0; row < rowCount; ++row) {
    double sum_m = 0;
    std::size_t count = 0;
    for (std::size_t column = 0; column < columnCount; ++column) {
      const std::uint32_t range = echoes.empty() ? 0 : echoes.front().range[row * columnCount + column];
      if (range == 0) continue;
      sum_m += range * rangeResolution_m;
      ++count;
    }
    text += mrpt::format(" %.4f", count ? sum_m / static_cast<double>(count) : 0.0);
  }
  return text;
}

}  // namespace s2s::obs
