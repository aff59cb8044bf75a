#include "oculus2rawlog/oculus_converter.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "oculus2rawlog/device_clock.h"
#include "oculus2rawlog/message_stream.h"
#include "s2s/core/error.h"
#include "s2s/core/progress.h"
#include "s2s/obs/rawlog_writer.h"

namespace s2s::tools::oculus {

namespace {

constexpr double kRadPerCentidegree = M_PI / 18000.0;

std::string hexText(unsigned value) {
  char text[20];
  std::snprintf(text, sizeof text, "0x%02x", value);
  return text;
}

class Converter {
 public:
  Converter(const OculusOptions& oculus, const ConverterOptions& options)
      : oculus_(oculus), options_(options), start_(options.startTime.value_or(kDefaultStartTime)) {}

  ConversionReport run(std::ostream* progressStream) {
    std::ifstream file(oculus_.input, std::ios::binary);
    std::error_code error;
    const auto fileBytes = std::filesystem::file_size(oculus_.input, error);
    if (!file || error)
      throw core::InputError("cannot open the file", oculus_.input, "check the path given with --input");
    const double megabytes = 1e-6 * static_cast<double>(fileBytes);
    core::Progress progress(progressStream, "reading", megabytes, "MB");
    obs::RawlogWriter writer(options_.output, {options_.gzLevel, 1.0});
    MessageStream stream(file);
    while (const auto message = stream.next()) {
      progress.update(1e-6 * static_cast<double>(stream.bytesRead()));
      take(*message, writer);
    }
    reportStream(stream);
    if (writer.count() == 0) refuse();
    writer.close();
    addNotes();
    return report_;
  }

 private:
  void take(const MessageStream::Message& message, obs::RawlogWriter& writer) {
    const std::string where = "byte " + std::to_string(message.at);
    if (message.header.type != kSimplePingResult) {
      report_.addSkipped("messages of type " + hexText(message.header.type) + ", which carry no simple ping", where);
      return;
    }
    const auto result = parsePing(message.bytes);
    if (!result.ping) {
      report_.addSkipped("pings with " + result.fault, where);
      return;
    }
    write(*result.ping, where, writer);
  }

  void write(const Ping& ping, const std::string& where, obs::RawlogWriter& writer) {
    const auto observation = toObservation(ping, oculus_);
    const std::int64_t device_ns = clock_.time_ns(ping);
    if (writer.count() == 0) first_ns_ = device_ns;
    observation->timestamp = core::toMrptTime(start_ + device_ns - first_ns_);
    observation->sensorLabel = options_.label;
    observation->sensorPose = core::toPose(options_.T_vehicle_sensor);
    observation->deviceTime_s = 1e-9 * static_cast<double>(device_ns);
    try {
      observation->checkConsistent();
      writer.write(observation);
    } catch (const core::InputError& e) {
      report_.addSkipped("pings that cannot be used: " + e.fault(), where);
      return;
    }
    report_.addRead(kPings);
    if (ping.startTime_s) hasAttitude_ = true;
    if (lastPingId_ && ping.pingId > *lastPingId_ + 1) lostPings_ += ping.pingId - *lastPingId_ - 1;
    lastPingId_ = ping.pingId;
    const auto size = std::to_string(ping.rangeCount) + " ranges x " + std::to_string(ping.beamCount) + " beams, " +
                      std::to_string(8 * ping.bytesPerSample) + " bit" + (ping.rowGains.empty() ? "" : ", with gains");
    report_.addNote("pings of " + size);
  }

  void reportStream(const MessageStream& stream) {
    if (stream.cutMessages() > 0) report_.addSkipped("messages that lost bytes on the way", {}, stream.cutMessages());
    if (stream.garbageBytes() > 0)
      report_.addSkipped("bytes that belong to no whole message", "byte " + std::to_string(stream.firstGarbageAt()),
                         stream.garbageBytes());
  }

  [[noreturn]] void refuse() const {
    std::string seen;
    for (const auto& line : report_.skipped()) seen += "; it has " + std::to_string(line.count) + " " + line.text;
    throw core::InputError("the file holds no simple ping result" + seen, oculus_.input,
                           "give the bytes of the sonar's TCP connection (port 52100), not a viewer's .oculus log");
  }

  void addNotes() {
    if (!options_.startTime)
      report_.addNote("the bytes carry no wall clock; the first ping is put at " + core::formatUtc(start_));
    report_.addNote("the vertical aperture is taken as " +
                    std::to_string(std::lround(oculus_.verticalAperture_rad * 180 / M_PI)) +
                    " degrees (--aperture-deg); the bytes do not tell it");
    if (hasAttitude_) report_.addNote("not kept: heading, pitch and roll of the sonar's own compass");
    if (lostPings_ > 0) report_.addNote(std::to_string(lostPings_) + " pings are missing by their numbers");
  }

  const OculusOptions& oculus_;
  const ConverterOptions& options_;
  core::TimeNs start_;
  std::int64_t first_ns_ = 0;
  DeviceClock clock_;
  std::optional<std::uint32_t> lastPingId_;
  std::uint64_t lostPings_ = 0;
  bool hasAttitude_ = false;
  ConversionReport report_;
};

}  // namespace

obs::CObservationImagingSonar::Ptr toObservation(const Ping& ping, const OculusOptions& oculus) {
  auto observation = obs::CObservationImagingSonar::Create();
  observation->sensorModel = oculus.model;
  observation->beamCount = ping.beamCount;
  observation->rangeCount = ping.rangeCount;
  observation->bytesPerSample = ping.bytesPerSample;
  observation->samples = ping.samples;
  observation->rowGains = ping.rowGains;
  for (const std::int16_t bearing : ping.bearings_cdeg)
    observation->bearings_rad.push_back(static_cast<float>(-kRadPerCentidegree * bearing));
  observation->rangeResolution_m = ping.rangeResolution_m;
  observation->verticalAperture_rad = oculus.verticalAperture_rad;
  observation->bearingModel = oculus.bearingModel;
  observation->soundSpeed_mps = ping.soundSpeed_mps;
  observation->frequency_hz = ping.frequency_hz;
  observation->gain_percent = ping.gain_percent;
  observation->pingId = ping.pingId;
  return observation;
}

ConversionReport convertOculusStream(const OculusOptions& oculus, const ConverterOptions& options,
                                     std::ostream* progress) {
  return Converter(oculus, options).run(progress);
}

}  // namespace s2s::tools::oculus
