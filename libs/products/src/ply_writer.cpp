#include "s2s/products/ply_writer.h"

#include "little_endian.h"

namespace s2s::products {

namespace {

constexpr std::size_t kBufferBytes = 1 << 20;
constexpr std::size_t kCountDigits = 20;

/// The header has the same length for every count, because it is written anew at the end: the comment takes up the
/// digits that the count leaves.
std::string header(std::uint64_t count, PlyPointWriter::Columns columns) {
  const std::string digits = std::to_string(count);
  std::string text =
      "ply\nformat binary_little_endian 1.0\n"
      "comment Seabed-to-Sky; map frame, metres, z up; sigma in metres; time in Unix seconds";
  text += std::string(kCountDigits - digits.size(), ' ') + "\nelement vertex " + digits + "\n";
  text +=
      "property double x\nproperty double y\nproperty double z\n"
      "property float intensity\nproperty float sigma\nproperty double time\nproperty float interval\n";
  if (columns == PlyPointWriter::Columns::WithLayer) text += "property uchar layer\n";
  return text + "end_header\n";
}

}  // namespace

PlyPointWriter::PlyPointWriter(const std::string& path, Columns columns) : file_(path), columns_(columns) {
  file_.stream() << header(0, columns_);
  buffer_.reserve(kBufferBytes);
}

void PlyPointWriter::add(const map::MapPoint& point) {
  for (int axis = 0; axis < 3; ++axis) appendBytes(buffer_, point.p_map[axis]);
  appendBytes(buffer_, point.intensity);
  appendBytes(buffer_, point.sigma_m);
  appendBytes(buffer_, static_cast<double>(point.time) / static_cast<double>(core::kNsPerSecond));
  appendBytes(buffer_, point.interval_m);
  if (columns_ == Columns::WithLayer) appendBytes(buffer_, static_cast<std::uint8_t>(point.layer));
  ++count_;
  if (buffer_.size() + 64 > kBufferBytes) flush();
}

void PlyPointWriter::finish() {
  flush();
  file_.stream().seekp(0);
  file_.stream() << header(count_, columns_);
  file_.commit();
}

void PlyPointWriter::flush() {
  file_.stream().write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  buffer_.clear();
}

}  // namespace s2s::products
