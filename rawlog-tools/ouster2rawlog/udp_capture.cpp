#include "ouster2rawlog/udp_capture.h"

#include <pcap/pcap.h>

#include <cstdio>
#include <filesystem>

#include "s2s/core/error.h"
#include "s2s/core/time.h"

namespace s2s::tools::ouster {

struct UdpCapture::Handle {
  ~Handle() {
    if (pcap) pcap_close(pcap);
  }
  pcap_t* pcap = nullptr;
  int linkType = 0;
  std::uint64_t fileBytes = 0;
};

namespace {

std::size_t bigEndian16(const std::uint8_t* bytes) { return static_cast<std::size_t>(bytes[0]) << 8 | bytes[1]; }

/// Offset of the IP header behind Ethernet's, past VLAN tags; nothing if the frame carries no IP.
std::optional<std::size_t> ipInEthernet(const std::uint8_t* frame, std::size_t bytes) {
  std::size_t at = 12;
  while (at + 2 <= bytes) {
    const std::size_t type = bigEndian16(frame + at);
    if (type == 0x0800 || type == 0x86dd) return at + 2;
    if (type != 0x8100 && type != 0x88a8) return std::nullopt;
    at += 4;
  }
  return std::nullopt;
}

std::optional<std::size_t> ipOffset(int linkType, const std::uint8_t* frame, std::size_t bytes) {
  switch (linkType) {
    case DLT_EN10MB:
      return ipInEthernet(frame, bytes);
    case DLT_LINUX_SLL:
      return 16;
    case DLT_LINUX_SLL2:
      return 20;
    case DLT_NULL:
    case DLT_LOOP:
      return 4;
    default:
      return 0;  // DLT_RAW
  }
}

bool isKnown(int linkType) {
  for (const int known : {DLT_EN10MB, DLT_LINUX_SLL, DLT_LINUX_SLL2, DLT_NULL, DLT_LOOP, DLT_RAW, DLT_IPV4, DLT_IPV6})
    if (linkType == known) return true;
  return false;
}

}  // namespace

UdpCapture::UdpCapture(const std::string& path) : handle_(std::make_unique<Handle>()) {
  char message[PCAP_ERRBUF_SIZE] = "";
  handle_->pcap = pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_NANO, message);
  if (!handle_->pcap)
    throw core::InputError(std::string("cannot read the capture: ") + message, path, "give a pcap or pcapng file");
  handle_->linkType = pcap_datalink(handle_->pcap);
  if (!isKnown(handle_->linkType)) {
    const char* name = pcap_datalink_val_to_name(handle_->linkType);
    throw core::InputError(std::string("the capture's link type ") + (name ? name : "?") + " is not supported", path,
                           "capture from an Ethernet interface");
  }
  std::error_code ignored;
  handle_->fileBytes = std::filesystem::file_size(path, ignored);
}

UdpCapture::~UdpCapture() = default;

std::optional<UdpDatagram> UdpCapture::next() {
  while (fault_.empty()) {
    pcap_pkthdr* header = nullptr;
    const std::uint8_t* frame = nullptr;
    const int result = pcap_next_ex(handle_->pcap, &header, &frame);
    if (result == PCAP_ERROR) fault_ = pcap_geterr(handle_->pcap);
    if (result != 1) break;
    if (header->caplen < header->len) {
      ++cutPackets_;
      continue;
    }
    const auto offset = ipOffset(handle_->linkType, frame, header->caplen);
    if (!offset || *offset > header->caplen) continue;
    // With nanosecond precision, tv_usec holds nanoseconds.
    const core::TimeNs time = header->ts.tv_sec * core::kNsPerSecond + header->ts.tv_usec;
    if (auto datagram = reassembler_.add(frame + *offset, header->caplen - *offset, time)) return datagram;
  }
  reassembler_.finish();
  return std::nullopt;
}

double UdpCapture::shareRead() const {
  const auto position = std::ftell(pcap_file(handle_->pcap));
  return handle_->fileBytes == 0 ? 1.0 : static_cast<double>(position) / static_cast<double>(handle_->fileBytes);
}

}  // namespace s2s::tools::ouster
