#include "s2s/obs/CObservationImagingSonar.h"

#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <ostream>

#include "packed_vector.h"
#include "s2s/core/error.h"

using namespace s2s::obs;  // the macro below wants the bare class name
IMPLEMENTS_SERIALIZABLE(CObservationImagingSonar, mrpt::obs::CObservation, s2s::obs)

namespace s2s::obs {

namespace {

double degrees(double rad) { return rad * 180.0 / M_PI; }

bool strictlyMonotonic(const std::vector<float>& values) {
  for (std::size_t i = 2; i < values.size(); ++i)
    if ((values[i] - values[i - 1]) * (values[1] - values[0]) <= 0) return false;
  return values.size() < 2 || values[1] != values[0];
}

}  // namespace

std::uint8_t CObservationImagingSonar::serializeGetVersion() const { return 0; }

void CObservationImagingSonar::serializeTo(mrpt::serialization::CArchive& out) const {
  out << timestamp << sensorLabel << sensorModel << sensorPose;
  out << beamCount << rangeCount << bytesPerSample;
  packed::write(out, samples);
  packed::write(out, rowGains);
  packed::write(out, bearings_rad);
  out << rangeOffset_m << rangeResolution_m << verticalAperture_rad << static_cast<std::uint8_t>(bearingModel);
  out << soundSpeed_mps << frequency_hz << gain_percent << pingId << deviceTime_s;
}

void CObservationImagingSonar::serializeFrom(mrpt::serialization::CArchive& in, std::uint8_t version) {
  switch (version) {
    case 0: {
      in >> timestamp >> sensorLabel >> sensorModel >> sensorPose;
      in >> beamCount >> rangeCount >> bytesPerSample;
      packed::read(in, samples, "samples");
      packed::read(in, rowGains, "rowGains");
      packed::read(in, bearings_rad, "bearings_rad");
      in >> rangeOffset_m >> rangeResolution_m >> verticalAperture_rad;
      bearingModel = static_cast<BearingModel>(in.ReadAs<std::uint8_t>());
      in >> soundSpeed_mps >> frequency_hz >> gain_percent >> pingId >> deviceTime_s;
    } break;
    default:
      MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  }
  checkConsistent();
}

std::uint32_t CObservationImagingSonar::sample(std::size_t bin, std::size_t beam) const {
  const std::uint8_t* bytes = samples.data() + (bin * beamCount + beam) * bytesPerSample;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytesPerSample; ++i) value |= static_cast<std::uint32_t>(bytes[i]) << (8 * i);
  return value;
}

std::uint32_t CObservationImagingSonar::maxSample() const {
  return bytesPerSample >= 4 ? 0xffffffffu : (1u << (8 * bytesPerSample)) - 1;
}

void CObservationImagingSonar::checkConsistent() const {
  const auto require = [this](bool good, const std::string& what) {
    if (!good)
      throw core::InputError(what, "sonar ping of '" + sensorLabel + "'",
                             "the record is damaged or its writer is at fault");
  };
  require(bytesPerSample >= 1 && bytesPerSample <= 4,
          "bytesPerSample is " + std::to_string(bytesPerSample) + ", not 1 to 4");
  require(samples.size() == static_cast<std::size_t>(beamCount) * rangeCount * bytesPerSample,
          std::to_string(samples.size()) + " bytes of samples for " + std::to_string(rangeCount) + " ranges x " +
              std::to_string(beamCount) + " beams x " + std::to_string(bytesPerSample) + " bytes");
  require(rowGains.empty() || rowGains.size() == rangeCount,
          std::to_string(rowGains.size()) + " row gains for " + std::to_string(rangeCount) + " ranges");
  require(bearings_rad.size() == beamCount,
          std::to_string(bearings_rad.size()) + " bearings for " + std::to_string(beamCount) + " beams");
  for (const float bearing : bearings_rad)
    require(std::isfinite(bearing) && std::abs(bearing) <= static_cast<float>(M_PI),
            "a bearing is not within +-180 deg");
  require(strictlyMonotonic(bearings_rad), "the bearings are not strictly monotonic");
  require(std::isfinite(rangeResolution_m) && (rangeResolution_m > 0 || rangeCount == 0),
          "the range resolution is " + std::to_string(rangeResolution_m) + " m");
  require(std::isfinite(rangeOffset_m) && rangeOffset_m >= 0,
          "the range offset is " + std::to_string(rangeOffset_m) + " m");
  require(verticalAperture_rad >= 0 && verticalAperture_rad <= M_PI, "the vertical aperture is not within 0..180 deg");
  require(bearingModel == BearingModel::Azimuth || bearingModel == BearingModel::Cone, "the bearing model is unknown");
}

void CObservationImagingSonar::getDescriptionAsText(std::ostream& o) const {
  CObservation::getDescriptionAsText(o);
  o << "Imaging sonar ping" << (sensorModel.empty() ? "" : " of a " + sensorModel) << "\n";
  o << "  image:             " << rangeCount << " ranges x " << beamCount << " beams, " << 8 * bytesPerSample << " bit"
    << (rowGains.empty() ? "" : ", with a gain for each row") << "\n";
  o << "  range:             " << rangeOffset_m << " to " << maxRange_m() << " m, bins of " << 1e3 * rangeResolution_m
    << " mm\n";
  if (!bearings_rad.empty())
    o << "  bearings:          " << degrees(bearings_rad.front()) << " to " << degrees(bearings_rad.back()) << " deg ("
      << (bearingModel == BearingModel::Azimuth ? "half-planes of constant azimuth" : "cones around the array")
      << ")\n";
  o << "  vertical aperture: " << degrees(verticalAperture_rad) << " deg\n";
  o << "  sound speed:       " << soundSpeed_mps << " m/s\n";
  o << "  frequency:         " << 1e-3 * frequency_hz << " kHz\n";
  o << "  gain:              " << (gain_percent < 0 ? std::string("unknown") : std::to_string(gain_percent) + " %")
    << "\n";
  o << "  ping number:       " << pingId << "\n";
  o << "  device clock:      " << (deviceTime_s < 0 ? std::string("none") : std::to_string(deviceTime_s) + " s")
    << "\n";
  o << "  sensor pose on the vehicle: " << sensorPose << "\n";
}

std::string CObservationImagingSonar::exportTxtHeader() const {
  return "rangeCount beamCount rangeOffset_m rangeResolution_m soundSpeed_mps "
         "strongest_range_m[beam 0..beamCount-1, 0 if all samples are 0]";
}

std::string CObservationImagingSonar::exportTxtDataRow() const {
  std::string row =
      mrpt::format("%u %u %.6f %.6f %.3f", rangeCount, beamCount, rangeOffset_m, rangeResolution_m, soundSpeed_mps);
  for (std::size_t beam = 0; beam < beamCount; ++beam) {
    std::uint32_t strongest = 0;
    double range_m = 0;
    for (std::size_t bin = 0; bin < rangeCount; ++bin) {
      const std::uint32_t value = sample(bin, beam);
      if (value <= strongest) continue;
      strongest = value;
      range_m = binRange_m(bin);
    }
    row += mrpt::format(" %.4f", range_m);
  }
  return row;
}

}  // namespace s2s::obs
