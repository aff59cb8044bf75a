#include "ply_parser.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

#include "s2s/core/error.h"

namespace s2s::products {

namespace {

constexpr std::size_t kBlockBytes = 1 << 20;
constexpr std::size_t kLongestHeaderLine = 4096;

const std::map<std::string, PlyType>& typeNames() {
  static const std::map<std::string, PlyType> kNames = {
      {"char", PlyType::Int8},     {"int8", PlyType::Int8},     {"uchar", PlyType::UInt8},
      {"uint8", PlyType::UInt8},   {"short", PlyType::Int16},   {"int16", PlyType::Int16},
      {"ushort", PlyType::UInt16}, {"uint16", PlyType::UInt16}, {"int", PlyType::Int32},
      {"int32", PlyType::Int32},   {"uint", PlyType::UInt32},   {"uint32", PlyType::UInt32},
      {"float", PlyType::Float},   {"float32", PlyType::Float}, {"double", PlyType::Double},
      {"float64", PlyType::Double}};
  return kNames;
}

std::size_t byteCount(PlyType type) {
  switch (type) {
    case PlyType::Int8:
    case PlyType::UInt8:
      return 1;
    case PlyType::Int16:
    case PlyType::UInt16:
      return 2;
    case PlyType::Double:
      return 8;
    default:
      return 4;
  }
}

template <class Number>
double decode(const char* bytes) {
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double decode(const char* bytes, PlyType type) {
  switch (type) {
    case PlyType::Int8:
      return decode<std::int8_t>(bytes);
    case PlyType::UInt8:
      return decode<std::uint8_t>(bytes);
    case PlyType::Int16:
      return decode<std::int16_t>(bytes);
    case PlyType::UInt16:
      return decode<std::uint16_t>(bytes);
    case PlyType::Int32:
      return decode<std::int32_t>(bytes);
    case PlyType::UInt32:
      return decode<std::uint32_t>(bytes);
    case PlyType::Float:
      return decode<float>(bytes);
    case PlyType::Double:
      return decode<double>(bytes);
  }
  return 0;
}

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

int PlyElement::find(const std::string& property) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return static_cast<int>(i);
  return -1;
}

PlyParser::PlyParser(const std::string& path) : path_(path), file_(path, std::ios::binary | std::ios::ate) {
  if (!file_) throw core::InputError("cannot open the PLY file", path, "check the name and the access rights");
  size_ = static_cast<std::uint64_t>(file_.tellg());
  file_.seekg(0);
  parseHeader();
  inHeader_ = false;
}

void PlyParser::fail(const std::string& what) const {
  const bool byLine = inHeader_ || format_ == Format::Ascii;
  throw core::InputError(what, path_ + (byLine ? ":" + std::to_string(line_) : " byte " + std::to_string(position())),
                         "write or copy the file anew");
}

bool PlyParser::fill() {
  // Keeps the unread rest in front, so that a number is never cut by the block's end.
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(next_));
  bufferOffset_ += next_;
  next_ = 0;
  const std::size_t rest = buffer_.size();
  buffer_.resize(rest + kBlockBytes);
  file_.read(buffer_.data() + rest, static_cast<std::streamsize>(kBlockBytes));
  buffer_.resize(rest + static_cast<std::size_t>(file_.gcount()));
  return buffer_.size() > rest;
}

std::string PlyParser::headerLine() {
  std::string text;
  while (next_ < buffer_.size() || fill()) {
    const char c = buffer_[next_++];
    if (c == '\n') {
      ++line_;
      if (!text.empty() && text.back() == '\r') text.pop_back();
      return text;
    }
    if (text.size() == kLongestHeaderLine) fail("this is no PLY file: a header line is endless");
    text += c;
  }
  fail("the PLY header has no end");
}

void PlyParser::parseHeader() {
  if (headerLine() != "ply") fail("this is no PLY file: it does not begin with the line 'ply'");
  bool formatKnown = false;
  for (;;) {
    std::istringstream words(headerLine());
    std::string keyword;
    words >> keyword;
    if (keyword == "end_header") break;
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format") {
      std::string name;
      words >> name;
      static const std::map<std::string, Format> kFormats = {
          {"ascii", Format::Ascii}, {"binary_little_endian", Format::Little}, {"binary_big_endian", Format::Big}};
      const auto known = kFormats.find(name);
      if (known == kFormats.end()) fail("unknown PLY format '" + name + "'");
      format_ = known->second;
      formatKnown = true;
    } else if (keyword == "element") {
      PlyElement element;
      std::string count;
      words >> element.name >> count;
      const auto end = std::from_chars(count.data(), count.data() + count.size(), element.count);
      if (count.empty() || end.ec != std::errc() || end.ptr != count.data() + count.size())
        fail("the PLY element '" + element.name + "' has no valid count");
      elements_.push_back(element);
    } else if (keyword == "property") {
      parseProperty(words);
    } else {
      fail("unknown PLY header keyword '" + keyword + "'");
    }
  }
  if (!formatKnown) fail("the PLY header names no format");
}

void PlyParser::parseProperty(std::istringstream& words) {
  if (elements_.empty()) fail("a PLY property stands before the first element");
  const auto type = [&](const std::string& name) {
    const auto known = typeNames().find(name);
    if (known == typeNames().end()) fail("unknown PLY number type '" + name + "'");
    return known->second;
  };
  PlyProperty property;
  std::string word;
  words >> word;
  if (word == "list") {
    property.isList = true;
    words >> word;
    property.countType = type(word);
    words >> word;
  }
  property.type = type(word);
  words >> property.name;
  if (property.name.empty()) fail("a PLY property has no name");
  elements_.back().properties.push_back(property);
}

void PlyParser::checkSize(const PlyElement& element) {
  std::uint64_t rowBytes = 0;
  for (const auto& property : element.properties) {
    const PlyType first = property.isList ? property.countType : property.type;
    rowBytes += format_ == Format::Ascii ? 2 : byteCount(first);  // ASCII: a digit and a separator
  }
  const std::uint64_t rest = size_ - std::min(size_, position()) + 1;  // the last separator may be missing
  if (rowBytes > 0 && element.count > rest / rowBytes)
    fail("the file is cut short: its header promises " + std::to_string(element.count) + " of '" + element.name +
         "', but only " + std::to_string(rest - 1) + " bytes follow");
}

void PlyParser::readElement(const PlyElement& element, const std::function<void(const PlyRow&)>& visit) {
  checkSize(element);
  PlyRow row;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    row.values.clear();
    row.begin.assign(1, 0);
    for (const auto& property : element.properties) {
      const std::uint64_t length = property.isList ? readListLength(property) : 1;
      for (std::uint64_t k = 0; k < length; ++k) row.values.push_back(readNumber(property.type));
      row.begin.push_back(row.values.size());
    }
    visit(row);
  }
}

std::uint64_t PlyParser::readListLength(const PlyProperty& property) {
  const double length = readNumber(property.countType);
  // Also false for NaN. A list cannot have more items than the file has bytes.
  if (!(length >= 0 && length <= static_cast<double>(size_) && length == std::floor(length)))
    fail("the PLY list '" + property.name + "' has an impossible length");
  return static_cast<std::uint64_t>(length);
}

double PlyParser::readNumber(PlyType type) { return format_ == Format::Ascii ? readAscii() : readBinary(type); }

double PlyParser::readBinary(PlyType type) {
  const std::size_t bytes = byteCount(type);
  while (buffer_.size() - next_ < bytes)
    if (!fill()) fail("the file is cut short: it ends inside a number");
  const char* at = buffer_.data() + next_;
  next_ += bytes;
  if (format_ == Format::Little) return decode(at, type);
  std::array<char, 8> swapped{};
  std::reverse_copy(at, at + bytes, swapped.begin());
  return decode(swapped.data(), type);
}

double PlyParser::readAscii() {
  std::string token;
  while (next_ < buffer_.size() || fill()) {
    const char c = buffer_[next_];
    if (isBlank(c) && !token.empty()) break;
    if (c == '\n') ++line_;
    if (!isBlank(c)) token += c;
    ++next_;
  }
  if (token.empty()) fail("the file is cut short: a number is missing");
  double value = 0;
  const auto end = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end.ec != std::errc() || end.ptr != token.data() + token.size()) fail("'" + token + "' is no number");
  return value;
}

}  // namespace s2s::products
