#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace s2s::products {

enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float, Double };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float;
  bool isList = false;
  PlyType countType = PlyType::UInt8;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Index of a property, or -1.
  int find(const std::string& property) const;
};

/// The numbers of one vertex, face, …: those of property i are values[begin[i]] … values[begin[i + 1] - 1].
struct PlyRow {
  std::vector<double> values;
  std::vector<std::size_t> begin;

  double scalar(int property) const { return values[begin[static_cast<std::size_t>(property)]]; }
};

/// Reads a PLY file from front to back: the header at construction, then element by element in the file's order.
class PlyParser {
 public:
  /// @throws core::InputError
  explicit PlyParser(const std::string& path);

  const std::vector<PlyElement>& elements() const { return elements_; }

  /// Reads all rows of the next element.
  /// @throws core::InputError
  void readElement(const PlyElement& element, const std::function<void(const PlyRow&)>& visit);

  /// @throws core::InputError at the place reached so far
  [[noreturn]] void fail(const std::string& what) const;

 private:
  enum class Format { Ascii, Little, Big };

  std::string headerLine();
  void parseHeader();
  void parseProperty(std::istringstream& words);
  void checkSize(const PlyElement& element);
  double readNumber(PlyType type);
  double readBinary(PlyType type);
  double readAscii();
  std::uint64_t readListLength(const PlyProperty& property);
  bool fill();
  std::uint64_t position() const { return bufferOffset_ + next_; }

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  Format format_ = Format::Ascii;
  std::vector<PlyElement> elements_;

  std::vector<char> buffer_;
  std::size_t next_ = 0;            ///< index of the next byte in the buffer
  std::uint64_t bufferOffset_ = 0;  ///< place of the buffer's first byte in the file
  std::uint64_t line_ = 1;
  bool inHeader_ = true;
};

}  // namespace s2s::products
