#pragma once

#include <string>
#include <vector>

namespace s2s::eval {

/// A table of text for people: first column left-aligned, the others right-aligned, columns two blanks apart.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) : header_(std::move(header)) {}

  /// Missing cells at the end stay empty.
  /// @pre not more cells than the header has
  void addRow(std::vector<std::string> cells);

  /// Header, a rule, the rows; each line ends with a newline.
  std::string print() const;

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

/// A number with fixed decimals; "-" if it is not finite.
std::string fixed(double value, int decimals);

}  // namespace s2s::eval
