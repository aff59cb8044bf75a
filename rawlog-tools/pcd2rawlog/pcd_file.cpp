#include "pcd2rawlog/pcd_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include "pcd2rawlog/lzf.h"
#include "pcd2rawlog/pcd_header.h"
#include "s2s/core/error.h"

namespace s2s::tools::pcd {

namespace {

/// The fields that are kept, as indices into the header's: x, y, z and perhaps the intensity.
struct Selection {
  std::vector<std::size_t> fields;
  std::vector<std::string> skipped;
};

std::string readWhole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw core::InputError("cannot open the file", path, "check that you may read it");
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) throw core::InputError("cannot read the file", path, "check the disk");
  return text;
}

Selection select(const PcdHeader& header, const std::string& path) {
  Selection selection;
  for (const char* name : {"x", "y", "z"}) {
    const auto index = header.fieldIndex(name);
    if (!index)
      throw core::InputError(std::string("the file has no field '") + name + "'", path, "convert clouds of points");
    selection.fields.push_back(*index);
  }
  for (const char* name : {"intensity", "i", "reflectivity"}) {
    const auto index = header.fieldIndex(name);
    if (!index) continue;
    selection.fields.push_back(*index);
    break;
  }
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    const bool padding = header.fields[i].name == "_";
    if (!padding && std::find(selection.fields.begin(), selection.fields.end(), i) == selection.fields.end())
      selection.skipped.push_back(header.fields[i].name);
  }
  return selection;
}

template <class T>
double load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double number(const PcdField& field, const char* bytes) {
  if (field.type == 'F') return field.size == 8 ? load<double>(bytes) : load<float>(bytes);
  switch (field.size) {
    case 1:
      return field.type == 'I' ? load<std::int8_t>(bytes) : load<std::uint8_t>(bytes);
    case 2:
      return field.type == 'I' ? load<std::int16_t>(bytes) : load<std::uint16_t>(bytes);
    case 4:
      return field.type == 'I' ? load<std::int32_t>(bytes) : load<std::uint32_t>(bytes);
    default:
      return field.type == 'I' ? load<std::int64_t>(bytes) : load<std::uint64_t>(bytes);
  }
}

void addPoint(PcdCloud& cloud, const std::vector<double>& values) {
  if (!std::isfinite(values[0]) || !std::isfinite(values[1]) || !std::isfinite(values[2])) {
    ++cloud.notFinite;
    return;
  }
  cloud.x.push_back(static_cast<float>(values[0]));
  cloud.y.push_back(static_cast<float>(values[1]));
  cloud.z.push_back(static_cast<float>(values[2]));
  if (values.size() > 3) cloud.intensity.push_back(std::isfinite(values[3]) ? static_cast<float>(values[3]) : 0.0f);
}

/// Where field f of point p begins is first[f] + p * step[f].
struct BinaryLayout {
  std::vector<std::size_t> first, step;
};

/// Binary files hold point after point, compressed ones field after field.
BinaryLayout layoutOf(const PcdHeader& header, bool fieldAfterField) {
  BinaryLayout layout;
  std::size_t at = 0;
  for (const auto& field : header.fields) {
    layout.first.push_back(at);
    layout.step.push_back(fieldAfterField ? field.bytes() : header.bytesPerPoint());
    at += fieldAfterField ? field.bytes() * header.pointCount : field.bytes();
  }
  return layout;
}

void readBinary(std::string_view data, const PcdHeader& header, const Selection& selection, bool fieldAfterField,
                const std::string& path, PcdCloud& cloud) {
  if (data.size() < header.pointCount * header.bytesPerPoint())
    throw core::InputError("the file ends early: " + std::to_string(data.size()) + " bytes of data for " +
                               std::to_string(header.pointCount) + " points of " +
                               std::to_string(header.bytesPerPoint()) + " bytes",
                           path, "copy the file again");
  const BinaryLayout layout = layoutOf(header, fieldAfterField);
  std::vector<double> values(selection.fields.size());
  for (std::size_t point = 0; point < header.pointCount; ++point) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t field = selection.fields[i];
      values[i] = number(header.fields[field], data.data() + layout.first[field] + point * layout.step[field]);
    }
    addPoint(cloud, values);
  }
}

std::string unpack(std::string_view data, std::size_t unpackedBytes, const std::string& path) {
  std::uint32_t sizes[2] = {0, 0};
  if (data.size() >= sizeof sizes) std::memcpy(sizes, data.data(), sizeof sizes);
  if (data.size() < sizeof sizes || data.size() - sizeof sizes < sizes[0])
    throw core::InputError("the file ends within its compressed data", path, "copy the file again");
  auto unpacked = lzfDecompress(data.substr(sizeof sizes, sizes[0]), unpackedBytes);
  if (!unpacked || sizes[1] != unpackedBytes)
    throw core::InputError("the compressed data are damaged", path, "copy the file again");
  return std::move(*unpacked);
}

/// Splits off the next word; empty at the end of the line.
std::string_view nextWord(std::string_view& line) {
  const auto first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  const auto last = std::min(line.find_first_of(" \t\r", first), line.size());
  const auto word = line.substr(first, last - first);
  line.remove_prefix(last);
  return word;
}

/// The numbers of one line in the order of the selection; false if one is missing or none.
bool parseLine(std::string_view line, const PcdHeader& header, const Selection& selection,
               std::vector<double>& values) {
  for (std::size_t field = 0; field < header.fields.size(); ++field)
    for (std::size_t element = 0; element < header.fields[field].count; ++element) {
      const auto word = nextWord(line);
      if (word.empty()) return false;
      const auto kept = std::find(selection.fields.begin(), selection.fields.end(), field);
      if (element > 0 || kept == selection.fields.end()) continue;
      double value = 0;
      const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
      if (result.ec != std::errc() || result.ptr != word.data() + word.size()) return false;
      values[static_cast<std::size_t>(kept - selection.fields.begin())] = value;
    }
  return true;
}

void readAscii(std::string_view data, const PcdHeader& header, const Selection& selection, const std::string& path,
               PcdCloud& cloud) {
  std::vector<double> values(selection.fields.size());
  for (std::size_t point = 0; point < header.pointCount;) {
    if (data.empty())
      throw core::InputError(
          "the file ends after " + std::to_string(point) + " of " + std::to_string(header.pointCount) + " points", path,
          "copy the file again");
    const auto end = std::min(data.find('\n'), data.size());
    const auto line = data.substr(0, end);
    data.remove_prefix(std::min(end + 1, data.size()));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    if (!parseLine(line, header, selection, values))
      throw core::InputError("point " + std::to_string(point) + " does not parse: '" + std::string(line) + "'", path,
                             "correct the line or leave the file out");
    addPoint(cloud, values);
    ++point;
  }
}

}  // namespace

PcdCloud readPcd(const std::string& path) {
  const std::string file = readWhole(path);
  const PcdHeader header = parsePcdHeader(file, path);
  const Selection selection = select(header, path);
  PcdCloud cloud;
  cloud.skippedFields = selection.skipped;
  cloud.hasViewpoint = header.hasViewpoint;
  const auto data = std::string_view(file).substr(header.dataBegin);
  switch (header.encoding) {
    case PcdEncoding::Ascii:
      readAscii(data, header, selection, path, cloud);
      break;
    case PcdEncoding::Binary:
      readBinary(data, header, selection, false, path, cloud);
      break;
    case PcdEncoding::BinaryCompressed:
      readBinary(unpack(data, header.pointCount * header.bytesPerPoint(), path), header, selection, true, path, cloud);
      break;
  }
  return cloud;
}

}  // namespace s2s::tools::pcd
