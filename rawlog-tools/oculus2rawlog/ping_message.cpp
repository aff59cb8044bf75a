#include "oculus2rawlog/ping_message.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace s2s::tools::oculus {

namespace {

constexpr std::uint16_t kSyncWord = 0x4f53;
/// 1024 beams x 4096 ranges x 4 bytes and some; no Oculus sends more.
constexpr std::uint32_t kMaxPayload = 32u << 20;
constexpr std::size_t kGainBytes = 4;

/// Simple fire, ping result, simple ping result, user configuration, dummy.
constexpr std::uint16_t kTypes[] = {0x15, 0x22, kSimplePingResult, 0x55, 0xff};

template <class T>
T load(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Where the fields of a ping result stand (Oculus.h of the maker's software; packed).
struct Layout {
  std::size_t pingId, frequency, soundSpeed, startTime, dataSize, rangeResolution, rangeCount, beamCount, imageOffset,
      imageSize, messageSize, bytes;
};
constexpr Layout kLayout1{53, 61, 85, 93, 97, 98, 106, 108, 110, 114, 118, 122};
constexpr Layout kLayout2{89, 97, 145, 153, 161, 162, 170, 172, 190, 194, 198, 202};
constexpr std::size_t kGainPercent = 29;  // in the fire message that both begin with

bool strictlyMonotonic(const std::vector<std::int16_t>& values) {
  const auto notRising = [](auto a, auto b) { return a >= b; };
  const auto notFalling = [](auto a, auto b) { return a <= b; };
  return std::adjacent_find(values.begin(), values.end(), notRising) == values.end() ||
         std::adjacent_find(values.begin(), values.end(), notFalling) == values.end();
}

/// Splits the image into gains and samples. False if its size fits neither with nor without gains.
bool readImage(std::string_view image, Ping& ping) {
  const std::size_t rowBytes = static_cast<std::size_t>(ping.beamCount) * ping.bytesPerSample;
  const bool plain = image.size() == ping.rangeCount * rowBytes;
  if (!plain && image.size() != ping.rangeCount * (rowBytes + kGainBytes)) return false;
  ping.samples.reserve(ping.rangeCount * rowBytes);
  for (std::size_t at = 0; at < image.size();) {
    if (!plain) {
      ping.rowGains.push_back(load<std::uint32_t>(image, at));
      at += kGainBytes;
    }
    ping.samples.insert(ping.samples.end(), image.begin() + static_cast<std::ptrdiff_t>(at),
                        image.begin() + static_cast<std::ptrdiff_t>(at + rowBytes));
    at += rowBytes;
  }
  return true;
}

Ping readFields(std::string_view message, const Layout& at, bool second) {
  Ping ping;
  ping.pingId = load<std::uint32_t>(message, at.pingId);
  ping.frequency_hz = load<double>(message, at.frequency);
  ping.soundSpeed_mps = load<double>(message, at.soundSpeed);
  ping.gain_percent = load<double>(message, kGainPercent);
  if (second)
    ping.startTime_s = load<double>(message, at.startTime);
  else
    ping.startTime_ns = load<std::uint32_t>(message, at.startTime);
  ping.rangeResolution_m = load<double>(message, at.rangeResolution);
  ping.rangeCount = load<std::uint16_t>(message, at.rangeCount);
  ping.beamCount = load<std::uint16_t>(message, at.beamCount);
  return ping;
}

}  // namespace

std::optional<MessageHeader> parseHeader(std::string_view bytes) {
  if (bytes.size() < MessageHeader::kBytes || load<std::uint16_t>(bytes, 0) != kSyncWord) return std::nullopt;
  MessageHeader header;
  header.source = load<std::uint16_t>(bytes, 2);
  header.destination = load<std::uint16_t>(bytes, 4);
  header.type = load<std::uint16_t>(bytes, 6);
  header.version = load<std::uint16_t>(bytes, 8);
  header.payloadBytes = load<std::uint32_t>(bytes, 10);
  const bool known = std::find(std::begin(kTypes), std::end(kTypes), header.type) != std::end(kTypes);
  if (!known || header.version > 255 || header.payloadBytes > kMaxPayload) return std::nullopt;
  return header;
}

PingResult parsePing(std::string_view message) {
  const auto fault = [](const std::string& text) { return PingResult{std::nullopt, text}; };
  const auto header = parseHeader(message);
  if (!header || header->type != kSimplePingResult) return fault("no simple ping result");
  const bool second = header->version == 2;
  const Layout& at = second ? kLayout2 : kLayout1;
  if (message.size() < header->messageBytes() || message.size() < at.bytes) return fault("the message ends early");

  Ping ping = readFields(message, at, second);
  const auto dataSize = load<std::uint8_t>(message, at.dataSize);
  const std::size_t imageOffset = load<std::uint32_t>(message, at.imageOffset);
  const std::size_t imageSize = load<std::uint32_t>(message, at.imageSize);
  if (dataSize > 3) return fault("unknown sample format " + std::to_string(dataSize));
  ping.bytesPerSample = static_cast<std::uint8_t>(dataSize + 1);
  if (ping.rangeCount == 0 || ping.beamCount == 0) return fault("an image of no size");
  if (!(ping.rangeResolution_m > 0 && ping.rangeResolution_m < 10)) return fault("an impossible range resolution");
  if (ping.startTime_s && !(*ping.startTime_s >= 0 && *ping.startTime_s < 1e9))
    return fault("an impossible start time");
  const std::size_t bearingsEnd = at.bytes + sizeof(std::int16_t) * ping.beamCount;
  if (load<std::uint32_t>(message, at.messageSize) != header->messageBytes() || imageOffset < bearingsEnd ||
      imageOffset + imageSize > header->messageBytes())
    return fault("sizes that contradict each other");

  ping.bearings_cdeg.resize(ping.beamCount);
  std::memcpy(ping.bearings_cdeg.data(), message.data() + at.bytes, bearingsEnd - at.bytes);
  if (!strictlyMonotonic(ping.bearings_cdeg)) return fault("bearings that are not in order");
  if (!readImage(message.substr(imageOffset, imageSize), ping))
    return fault("an image size that fits neither with nor without gains");
  return {std::move(ping), ""};
}

}  // namespace s2s::tools::oculus
