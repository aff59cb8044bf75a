#include "ouster_bytes.h"

#include <stdexcept>

#include "byte_writer.h"

namespace s2s::test {

std::string ousterMetadataJson(const std::string& profile, std::uint32_t columns, std::uint32_t columnsPerPacket) {
  return R"({"sensor_info": {"prod_line": "OS-1-4", "prod_sn": "122", "build_rev": "v3.0.1", "initialization_id": 77},
    "config_params": {"lidar_mode": ")" +
         std::to_string(columns) + R"(x10", "timestamp_mode": "TIME_FROM_INTERNAL_OSC", "udp_port_lidar": 7502},
    "beam_intrinsics": {"beam_altitude_angles": [15, 5, -5, -15], "beam_azimuth_angles": [3, 1, -1, -3],
      "beam_to_lidar_transform": [1,0,0,16.0, 0,1,0,0, 0,0,1,2.5, 0,0,0,1]},
    "lidar_intrinsics": {"lidar_to_sensor_transform": [-1,0,0,0, 0,-1,0,0, 0,0,1,36.18, 0,0,0,1]},
    "imu_intrinsics": {"imu_to_sensor_transform": [1,0,0,6.253, 0,1,0,-11.775, 0,0,1,7.645, 0,0,0,1]},
    "lidar_data_format": {"columns_per_frame": )" +
         std::to_string(columns) + R"(, "columns_per_packet": )" + std::to_string(columnsPerPacket) +
         R"(, "pixels_per_column": 4, "column_window": [0, )" + std::to_string(columns - 1) +
         R"(], "udp_profile_lidar": ")" + profile + R"(", "udp_profile_imu": "LEGACY"}})";
}

tools::ouster::Metadata ousterMetadata(const std::string& profile, std::uint32_t columns,
                                       std::uint32_t columnsPerPacket) {
  return tools::ouster::parseMetadata(ousterMetadataJson(profile, columns, columnsPerPacket), "test.json");
}

namespace {

/// The words of a pixel; bit positions as in the manual's drawings.
std::string pixelBytes(const std::string& profile, const OusterPixel& p) {
  ByteWriter out;
  const std::uint32_t unused = 0xa5;  // what a reader must mask away
  if (profile == "LEGACY") {
    out.add(p.range | p.flags << 28)
        .add(p.reflectivity | unused << 8 | p.signal << 16)
        .add(p.nearInfrared | unused << 16);
  } else if (profile == "RNG19_RFL8_SIG16_NIR16") {
    out.add(p.range | p.flags << 19 | unused << 24).add(p.reflectivity | unused << 8 | p.signal << 16);
    out.add(p.nearInfrared | unused << 16);
  } else if (profile == "RNG19_RFL8_SIG16_NIR16_DUAL") {
    out.add(p.range | p.flags << 19 | p.reflectivity << 24).add(p.range2 | p.flags2 << 19 | p.reflectivity2 << 24);
    out.add(p.signal | p.signal2 << 16).add(p.nearInfrared | unused << 16);
  } else if (profile == "RNG15_RFL8_NIR8") {
    out.add(p.range | p.flags << 15 | p.reflectivity << 16 | p.nearInfrared << 24);
  } else if (profile == "RNG15_RFL8_NIR8_DUAL" || profile == "FUSA_RNG15_RFL8_NIR8_DUAL") {
    out.add(p.range | p.flags << 15 | p.reflectivity << 16 | p.nearInfrared << 24);
    out.add(p.range2 | p.flags2 << 15 | p.reflectivity2 << 16 | unused << 24);
  } else {
    throw std::runtime_error("no layout for " + profile);
  }
  return out.bytes();
}

std::string packetHeader(const tools::ouster::Metadata& metadata, std::uint32_t frameId) {
  ByteWriter out;
  if (metadata.fusaHeader)  // type u8, init id u24, frame u32, alert u8, 2 unused, serial number u40
    out.add(0x00004d01u).add(frameId).zeros(3).add(std::uint32_t{122}).zeros(1);
  else  // type u16, frame u16, init id u24, serial number u40
    out.add(std::uint16_t{1})
        .add(static_cast<std::uint16_t>(frameId))
        .add(std::uint16_t{77})
        .zeros(1)
        .add(122u)
        .zeros(1);
  return out.zeros(32 - out.bytes().size()).bytes();
}

}  // namespace

std::string OusterPacketMaker::packet(std::uint32_t frameId, std::uint32_t firstColumn) const {
  const bool legacy = metadata.lidarProfile == "LEGACY";
  ByteWriter out;
  if (!legacy) out.add(packetHeader(metadata, frameId));
  for (std::uint32_t c = 0; c < metadata.columnsPerPacket; ++c) {
    const std::uint32_t column = firstColumn + c;
    const bool good = valid(column);
    out.add(std::uint64_t{time(column)}).add(static_cast<std::uint16_t>(column));
    if (legacy)
      out.add(static_cast<std::uint16_t>(frameId)).add(std::uint32_t{88u * column});
    else
      out.add(static_cast<std::uint16_t>(good ? 1 : 0));
    for (std::uint32_t row = 0; row < metadata.rows; ++row)
      out.add(pixelBytes(metadata.lidarProfile, pixel(row, column)));
    if (legacy) out.add(good ? 0xffffffffu : 0u);
  }
  if (!legacy) out.zeros(32);
  return out.bytes();
}

}  // namespace s2s::test
