#pragma once

#include <iosfwd>
#include <string>

#include "common/conversion_report.h"
#include "common/converter_options.h"
#include "oculus2rawlog/ping_message.h"
#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::tools::oculus {

struct OculusOptions {
  std::string input;                                  ///< file with the bytes of the TCP connection
  std::string model = "Oculus";                       ///< pings do not tell it
  double verticalAperture_rad = 0.34906585039886592;  ///< 20 degrees; pings do not tell it
  obs::BearingModel bearingModel = obs::BearingModel::Azimuth;
};

constexpr const char* kPings = "pings";

/// The ping as an observation without time, label and pose. Oculus bearings grow to starboard, ours to port (+y): their
/// sign is turned, the order of the beams and the samples stay.
obs::CObservationImagingSonar::Ptr toObservation(const Ping& ping, const OculusOptions& oculus);

/// Writes every simple ping result of the stream.
/// @param progress where to show progress; null for nowhere
/// @throws core::InputError if the file cannot be read or holds no ping, core::OutputError
ConversionReport convertOculusStream(const OculusOptions& oculus, const ConverterOptions& options,
                                     std::ostream* progress = nullptr);

}  // namespace s2s::tools::oculus
