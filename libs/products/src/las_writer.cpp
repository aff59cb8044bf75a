#include "s2s/products/las_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>

#include "little_endian.h"
#include "s2s/products/gps_time.h"
#include "s2s/products/grid_files.h"

namespace s2s::products {

namespace {

// Sizes and codes of ASPRS LAS 1.4-R15.
constexpr std::size_t kHeaderBytes = 375, kVlrHeaderBytes = 54, kExtraBytesDescriptorBytes = 192;
constexpr std::uint16_t kPointBytes = 30 + sizeof(float);
constexpr std::uint8_t kPointFormat = 6;
constexpr std::uint16_t kGlobalEncoding = 1 << 0 | 1 << 4;  // adjusted standard GPS time; reference given as WKT
constexpr std::uint8_t kUnclassified = 1, kBathymetricPoint = 40;
constexpr std::uint8_t kOnlyReturn = 1 | 1 << 4;  // return 1 of 1
constexpr std::uint8_t kFloatType = 9;
constexpr std::size_t kBufferBytes = 1 << 20;

void putText(std::vector<char>& out, std::size_t at, const std::string& text, std::size_t room) {
  std::memcpy(out.data() + at, text.data(), std::min(text.size(), room));
}

void appendVlrHeader(std::vector<char>& out, const std::string& user, std::uint16_t record, std::size_t length,
                     const std::string& description) {
  const std::size_t at = out.size();
  out.resize(at + kVlrHeaderBytes, 0);
  putText(out, at + 2, user, 16);
  putBytes(out, at + 18, record);
  putBytes(out, at + 20, static_cast<std::uint16_t>(length));
  putText(out, at + 22, description, 32);
}

void appendWkt(std::vector<char>& out, const std::string& wkt) {
  appendVlrHeader(out, "LASF_Projection", 2112, wkt.size() + 1, "local reference, WKT");
  out.insert(out.end(), wkt.begin(), wkt.end());
  out.push_back(0);
}

void appendSigmaDescriptor(std::vector<char>& out) {
  appendVlrHeader(out, "LASF_Spec", 4, kExtraBytesDescriptorBytes, "extra bytes");
  const std::size_t at = out.size();
  out.resize(at + kExtraBytesDescriptorBytes, 0);
  putBytes(out, at + 2, kFloatType);
  putText(out, at + 4, "sigma", 32);
  putText(out, at + 160, "std. dev. of position [m]", 32);
}

}  // namespace

double lasIntensityFactor(double largestIntensity) {
  if (largestIntensity <= 1) return 65535;
  return largestIntensity <= 255 ? 65535.0 / 255 : 1;
}

LasWriter::LasWriter(const std::string& path, const LasFrame& frame) : file_(path), frame_(frame), wkt_(localCrsWkt()) {
  min_.setConstant(std::numeric_limits<std::int32_t>::max());
  max_.setConstant(std::numeric_limits<std::int32_t>::min());
  const auto bytes = header();
  file_.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  buffer_.reserve(kBufferBytes);
}

bool LasWriter::add(const map::MapPoint& point) {
  const Eigen::Array3d scaled = ((point.p_map - frame_.offset_m) / kScale_m).array().round();
  // NaN fails the comparison too; maxCoeff() would pass over it.
  if (!(scaled.abs() <= static_cast<double>(std::numeric_limits<std::int32_t>::max())).all()) return false;
  const Eigen::Array<std::int32_t, 3, 1> xyz = scaled.cast<std::int32_t>();
  min_ = min_.min(xyz);
  max_ = max_.max(xyz);
  const bool lidar = point.layer == map::Layer::Lidar;
  const double intensity = frame_.intensityFactor[static_cast<std::size_t>(point.layer)] * point.intensity;
  for (int axis = 0; axis < 3; ++axis) appendBytes(buffer_, xyz[axis]);
  appendBytes(buffer_, static_cast<std::uint16_t>(intensity > 0 ? std::min(std::round(intensity), 65535.0) : 0));
  appendBytes(buffer_, kOnlyReturn);
  appendBytes(buffer_, std::uint8_t{0});  // flags, scanner channel, scan direction
  appendBytes(buffer_, lidar ? kUnclassified : kBathymetricPoint);
  appendBytes(buffer_, static_cast<std::uint8_t>(point.layer));
  appendBytes(buffer_, std::int16_t{0});   // scan angle
  appendBytes(buffer_, std::uint16_t{0});  // point source: this file
  appendBytes(buffer_, adjustedGpsTime_s(point.time));
  appendBytes(buffer_, point.sigma_m);
  ++count_;
  if (buffer_.size() + kPointBytes > kBufferBytes) flush();
  return true;
}

std::vector<char> LasWriter::header() const {
  std::vector<char> out(kHeaderBytes, 0);
  const std::time_t seconds = frame_.surveyTime / core::kNsPerSecond;
  std::tm day{};
  gmtime_r(&seconds, &day);
  putText(out, 0, "LASF", 4);
  putBytes(out, 6, kGlobalEncoding);
  putBytes(out, 24, std::uint8_t{1});
  putBytes(out, 25, std::uint8_t{4});
  putText(out, 26, "OTHER", 32);
  putText(out, 58, "Seabed-to-Sky " S2S_VERSION, 31);
  putBytes(out, 90, static_cast<std::uint16_t>(day.tm_yday + 1));
  putBytes(out, 92, static_cast<std::uint16_t>(day.tm_year + 1900));
  putBytes(out, 94, static_cast<std::uint16_t>(kHeaderBytes));
  putBytes(out, 100, std::uint32_t{2});  // variable length records
  putBytes(out, 104, kPointFormat);
  putBytes(out, 105, kPointBytes);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<int>(axis);
    putBytes(out, 131 + 8 * axis, kScale_m);
    putBytes(out, 155 + 8 * axis, frame_.offset_m[i]);
    const bool empty = count_ == 0;
    putBytes(out, 179 + 16 * axis, empty ? 0.0 : max_[i] * kScale_m + frame_.offset_m[i]);
    putBytes(out, 187 + 16 * axis, empty ? 0.0 : min_[i] * kScale_m + frame_.offset_m[i]);
  }
  putBytes(out, 247, count_);
  putBytes(out, 255, count_);  // all are first returns
  appendWkt(out, wkt_);
  appendSigmaDescriptor(out);
  putBytes(out, 96, static_cast<std::uint32_t>(out.size()));  // offset to the points
  return out;
}

void LasWriter::finish() {
  flush();
  const auto bytes = header();
  file_.stream().seekp(0);
  file_.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file_.commit();
}

void LasWriter::flush() {
  file_.stream().write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  buffer_.clear();
}

}  // namespace s2s::products
