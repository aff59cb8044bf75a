#include "pcd2rawlog/pcd_header.h"

#include <charconv>
#include <sstream>

#include "s2s/core/error.h"

namespace s2s::tools::pcd {

namespace {

/// More points than any LiDAR delivers in one file; a count above it is damage and must not be allocated.
constexpr std::size_t kMaxPoints = std::size_t{1} << 30;

[[noreturn]] void refuse(const std::string& what, const std::string& path) {
  throw core::InputError(what, path, "check that this is a PCD file of version 0.6 or 0.7");
}

std::vector<std::string> wordsOf(std::string_view line) {
  std::istringstream in{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::size_t toCount(const std::string& word, const std::string& key, const std::string& path) {
  std::size_t value = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  if (result.ec != std::errc() || result.ptr != word.data() + word.size() || value > kMaxPoints)
    refuse("'" + word + "' is not a usable number in the header line " + key, path);
  return value;
}

bool isKnown(const std::string& key) {
  for (const char* known : {"SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"})
    if (key == known) return true;
  return false;
}

PcdEncoding toEncoding(const std::string& word, const std::string& path) {
  if (word == "ascii") return PcdEncoding::Ascii;
  if (word == "binary") return PcdEncoding::Binary;
  if (word == "binary_compressed") return PcdEncoding::BinaryCompressed;
  refuse("the data encoding '" + word + "' is unknown", path);
}

/// Collects header lines until DATA.
class HeaderParser {
 public:
  explicit HeaderParser(const std::string& path) : path_(path) {}

  /// True after the line DATA, the last one.
  bool take(const std::vector<std::string>& words) {
    if (words.empty() || words[0][0] == '#') return false;
    const std::string& key = words[0];
    const std::vector<std::string> values(words.begin() + 1, words.end());
    if (key == "VERSION") return false;
    if (key == "FIELDS" || key == "COLUMNS") {
      for (const auto& name : values) header_.fields.push_back({name});
      return false;
    }
    if (!isKnown(key)) refuse("the header line '" + key + "' is unknown", path_);
    if (values.empty()) refuse("the header line " + key + " is empty", path_);
    if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
      takePerField(key, values);
    } else if (key == "WIDTH") {
      width_ = toCount(values[0], key, path_);
    } else if (key == "HEIGHT") {
      height_ = toCount(values[0], key, path_);
    } else if (key == "VIEWPOINT") {
      header_.hasViewpoint = values != std::vector<std::string>{"0", "0", "0", "1", "0", "0", "0"};
    } else if (key == "POINTS") {
      points_ = toCount(values[0], key, path_);
    } else if (key == "DATA") {
      header_.encoding = toEncoding(values[0], path_);
      return true;
    }
    return false;
  }

  PcdHeader finish(std::size_t dataBegin) {
    if (header_.fields.empty()) refuse("the header has no FIELDS", path_);
    for (const auto& field : header_.fields)
      if (field.count == 0 || (field.type == 'F' && field.size < 4))
        refuse("the field '" + field.name + "' has an impossible SIZE or COUNT", path_);
    if (!points_ && !width_) refuse("the header has neither POINTS nor WIDTH", path_);
    header_.pointCount = points_.value_or(width_.value_or(0) * height_);
    if (header_.pointCount > kMaxPoints) refuse("the header claims too many points", path_);
    if (points_ && width_ && *points_ != *width_ * height_) refuse("POINTS is not WIDTH times HEIGHT", path_);
    header_.dataBegin = dataBegin;
    return header_;
  }

 private:
  void takePerField(const std::string& key, const std::vector<std::string>& values) {
    if (values.size() != header_.fields.size()) refuse(key + " has not one value for each of FIELDS", path_);
    for (std::size_t i = 0; i < values.size(); ++i) {
      PcdField& field = header_.fields[i];
      if (key == "TYPE") {
        if (values[i] != "F" && values[i] != "I" && values[i] != "U")
          refuse("TYPE " + values[i] + " is unknown", path_);
        field.type = values[i][0];
      } else if (key == "SIZE") {
        field.size = toCount(values[i], key, path_);
        if (field.size != 1 && field.size != 2 && field.size != 4 && field.size != 8)
          refuse("SIZE " + values[i] + " is not 1, 2, 4 or 8", path_);
      } else {
        field.count = toCount(values[i], key, path_);
        if (field.count > 4096) refuse("COUNT " + values[i] + " is too large", path_);
      }
    }
  }

  const std::string& path_;
  PcdHeader header_;
  std::optional<std::size_t> width_, points_;
  std::size_t height_ = 1;
};

}  // namespace

std::size_t PcdHeader::bytesPerPoint() const {
  std::size_t sum = 0;
  for (const auto& field : fields) sum += field.bytes();
  return sum;
}

std::optional<std::size_t> PcdHeader::fieldIndex(const std::string& name) const {
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].name == name) return i;
  return std::nullopt;
}

PcdHeader parsePcdHeader(std::string_view file, const std::string& path) {
  HeaderParser parser(path);
  std::size_t at = 0;
  while (at < file.size()) {
    const std::size_t end = file.find('\n', at);
    if (end == std::string_view::npos) break;
    const auto words = wordsOf(file.substr(at, end - at));
    at = end + 1;
    if (parser.take(words)) return parser.finish(at);
  }
  refuse("the header has no DATA line", path);
}

}  // namespace s2s::tools::pcd
