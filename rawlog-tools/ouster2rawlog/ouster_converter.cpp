#include "ouster2rawlog/ouster_converter.h"

#include <mrpt/obs/CObservationIMU.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "ouster2rawlog/imu_packet.h"
#include "ouster2rawlog/lidar_packet.h"
#include "ouster2rawlog/metadata.h"
#include "ouster2rawlog/sweep_builder.h"
#include "ouster2rawlog/time_base.h"
#include "ouster2rawlog/udp_capture.h"
#include "s2s/core/error.h"
#include "s2s/core/progress.h"
#include "s2s/obs/rawlog_writer.h"

namespace s2s::tools::ouster {

namespace {

/// Successive sweeps further apart than this, or backwards, mean that the clock was set.
constexpr double kClockJump_s = 60;

/// Which datagrams are the chosen sensor's. What the user does not choose is taken from the first LiDAR packet.
struct Selection {
  std::string source;
  std::optional<std::uint16_t> lidarPort;

  bool admitsLidar(const UdpDatagram& datagram) const {
    return (source.empty() || datagram.source == source) && (!lidarPort || datagram.destinationPort == *lidarPort);
  }
};

class Converter {
 public:
  Converter(const OusterOptions& ouster, const ConverterOptions& options)
      : ouster_(ouster),
        options_(options),
        metadata_(loadMetadata(ouster.metadata)),
        format_(metadata_),
        selection_{ouster.source, ouster.lidarPort} {}

  ConversionReport run(std::ostream* progressStream) {
    const TimeBase timeBase = survey();
    timeOffset_ns_ = timeBase.offset_ns;
    SweepBuilder builder(metadata_, format_, timeBase.offset_ns, timeBase.ownClock);
    obs::RawlogWriter writer(options_.output, {options_.gzLevel, 2.0});
    UdpCapture capture(ouster_.capture);
    const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(ouster_.capture));
    core::Progress progress(progressStream, "reading", megabytes, "MB");
    while (const auto datagram = capture.next()) {
      progress.update(megabytes * capture.shareRead());
      if (isLidar(*datagram))
        writeSweep(builder.add(datagram->payload.data()), writer);
      else
        writeImu(*datagram, writer);
    }
    writeSweep(builder.finish(), writer);
    writer.close();
    noteMetadata();
    report_.addNote(timeBase.text);
    reportCapture(capture);
    reportSweeps(builder.statistics());
    return report_;
  }

 private:
  /// A first look at the capture: which sensor, and how its clock relates to UTC.
  TimeBase survey() {
    UdpCapture capture(ouster_.capture);
    TimeBaseFinder finder(format_);
    std::map<std::size_t, std::uint64_t> sizes;
    bool found = false;
    while (const auto datagram = capture.next()) {
      ++sizes[datagram->payload.size()];
      if (datagram->payload.size() != format_.packetBytes() || !selection_.admitsLidar(*datagram)) continue;
      selection_ = {datagram->source, datagram->destinationPort};
      found = true;
      if (!finder.add(*datagram)) break;
    }
    if (!found) refuse(sizes, capture);
    return finder.result(options_.startTime);
  }

  [[noreturn]] void refuse(const std::map<std::size_t, std::uint64_t>& sizes, const UdpCapture& capture) const {
    std::string seen;
    for (const auto& [bytes, count] : sizes)
      seen += (seen.empty() ? "; it has " : ", ") + std::to_string(count) + " of " + std::to_string(bytes) + " bytes";
    if (!capture.fault().empty()) seen += "; reading ended early: " + capture.fault();
    throw core::InputError(
        "the capture has no LiDAR packet of " + std::to_string(format_.packetBytes()) +
            " bytes (UDP payload), as profile " + metadata_.lidarProfile + " of the metadata wants" + seen,
        ouster_.capture, "give the metadata of this very capture, and check --source and --lidar-port");
  }

  bool isLidar(const UdpDatagram& datagram) {
    if (datagram.payload.size() != format_.packetBytes()) return false;
    if (!selection_.admitsLidar(datagram)) return false;
    const PacketHeader header = format_.header(datagram.payload.data());
    if (header.type != 1) return false;
    if (metadata_.initializationId && header.initializationId != 0 &&
        header.initializationId != *metadata_.initializationId)
      report_.addNote("packets were made after another initialisation of the sensor than the metadata");
    if (header.serialNumber != 0 && std::to_string(header.serialNumber) != metadata_.serialNumber)
      report_.addNote("packets come from sensor " + std::to_string(header.serialNumber) + ", the metadata from " +
                      metadata_.serialNumber + ": beam angles may be wrong");
    report_.addRead(kLidarPackets);
    return true;
  }

  void writeSweep(const obs::CObservationLidarSweep::Ptr& sweep, obs::RawlogWriter& writer) {
    if (!sweep) return;
    sweep->sensorLabel = options_.label;
    sweep->sensorPose = core::toPose(options_.T_vehicle_sensor);
    const core::TimeNs time = core::fromMrptTime(sweep->timestamp);
    if (lastSweep_ && std::abs(core::secondsBetween(*lastSweep_, time)) > kClockJump_s)
      report_.addNote("the sensor's clock jumps by " + core::formatUnixTime(time - *lastSweep_) + " s at " +
                      core::formatUtc(*lastSweep_) + ": split the capture there");
    lastSweep_ = time;
    write(sweep, kSweeps, writer);
  }

  void write(const mrpt::obs::CObservation::Ptr& observation, const char* name, obs::RawlogWriter& writer) {
    try {
      writer.write(observation);
      report_.addRead(name);
    } catch (const core::InputError& e) {
      report_.addSkipped(std::string(name) + " because the sensor's clock ran backwards", e.where());
    }
  }

  void writeImu(const UdpDatagram& datagram, obs::RawlogWriter& writer) {
    if (datagram.source != selection_.source) {
      report_.addSkipped("packets of another sender", datagram.source);
      return;
    }
    if (!isImuPacketSize(datagram.payload.size())) {
      report_.addSkipped("packets of " + std::to_string(datagram.payload.size()) +
                             " bytes, which are neither this sensor's LiDAR nor IMU packets",
                         "to port " + std::to_string(datagram.destinationPort));
      return;
    }
    if (!imuPort_) imuPort_ = datagram.destinationPort;
    if (datagram.destinationPort != *imuPort_) {
      report_.addSkipped("IMU packets to another port", "port " + std::to_string(datagram.destinationPort));
      return;
    }
    for (const auto& reading : parseImuPacket(datagram.payload.data(), datagram.payload.size())) {
      if (reading.time_ns > kLatestDeviceTime_ns)
        report_.addSkipped("IMU readings with an impossible time");
      else
        write(toObservation(reading), kImuReadings, writer);
    }
  }

  mrpt::obs::CObservationIMU::Ptr toObservation(const ImuReading& reading) const {
    using namespace mrpt::obs;
    auto imu = CObservationIMU::Create();
    imu->timestamp = core::toMrptTime(static_cast<core::TimeNs>(reading.time_ns) + timeOffset_ns_);
    imu->sensorLabel = ouster_.imuLabel;
    imu->sensorPose = core::toPose(options_.T_vehicle_sensor * metadata_.T_sensor_imu);
    imu->set(IMU_X_ACC, reading.acceleration_mps2.x());
    imu->set(IMU_Y_ACC, reading.acceleration_mps2.y());
    imu->set(IMU_Z_ACC, reading.acceleration_mps2.z());
    imu->set(IMU_WX, reading.turnRate_radps.x());
    imu->set(IMU_WY, reading.turnRate_radps.y());
    imu->set(IMU_WZ, reading.turnRate_radps.z());
    return imu;
  }

  void noteMetadata() {
    report_.addNote(metadata_.model + ", firmware " + metadata_.firmware + ", " + std::to_string(metadata_.rows) +
                    " x " + std::to_string(metadata_.columns) + ", profile " + metadata_.lidarProfile + ", from " +
                    selection_.source + " to port " + std::to_string(*selection_.lidarPort));
    for (const auto& assumed : metadata_.assumed) report_.addNote("metadata has " + assumed + " is taken");
    if (!format_.profile().notKept.empty()) report_.addNote("not kept of each pixel: " + format_.profile().notKept);
    if (metadata_.timestampMode == "TIME_FROM_PTP_1588")
      report_.addNote("the sensor's time comes by PTP: if its master sends TAI, it is 37 s ahead of UTC");
  }

  void reportCapture(const UdpCapture& capture) {
    const auto& network = capture.statistics();
    const auto skipped = [this](std::uint64_t count, const char* why) {
      if (count > 0) report_.addSkipped(why, {}, count);
    };
    skipped(network.notUdp, "network packets that are not UDP");
    skipped(network.malformed, "malformed network packets");
    skipped(network.incompleteDatagrams, "UDP datagrams of which a fragment is missing");
    skipped(capture.cutPackets(), "network packets that were recorded only in part (capture with -s 0)");
    if (!capture.fault().empty()) report_.addSkipped("rest of the capture: " + capture.fault(), ouster_.capture);
  }

  void reportSweeps(const SweepBuilder::Statistics& sweeps) {
    if (sweeps.lateColumns > 0)
      report_.addSkipped("columns that came after their sweep was finished", {}, sweeps.lateColumns);
    if (sweeps.impossibleColumns > 0)
      report_.addSkipped("columns with an impossible number or time", {}, sweeps.impossibleColumns);
    if (sweeps.emptySweeps > 0) report_.addSkipped("sweeps without a valid column", {}, sweeps.emptySweeps);
    if (sweeps.incompleteSweeps > 0)
      report_.addNote(std::to_string(sweeps.incompleteSweeps) + " sweeps lack columns that were not received, " +
                      std::to_string(sweeps.missingColumns) + " in all");
  }

  const OusterOptions& ouster_;
  const ConverterOptions& options_;
  Metadata metadata_;
  LidarPacketFormat format_;
  Selection selection_;
  std::optional<std::uint16_t> imuPort_;
  std::int64_t timeOffset_ns_ = 0;
  std::optional<core::TimeNs> lastSweep_;
  ConversionReport report_;
};

}  // namespace

ConversionReport convertOusterCapture(const OusterOptions& ouster, const ConverterOptions& options,
                                      std::ostream* progress) {
  return Converter(ouster, options).run(progress);
}

}  // namespace s2s::tools::ouster
