#include "s2s/eval/text_table.h"

#include <mrpt/core/exceptions.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace s2s::eval {

namespace {

/// Characters on the screen: bytes of UTF-8 that do not continue a character.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

void TextTable::addRow(std::vector<std::string> cells) {
  ASSERT_LE_(cells.size(), header_.size());
  cells.resize(header_.size());
  rows_.push_back(std::move(cells));
}

std::string TextTable::print() const {
  std::vector<std::size_t> widths;
  for (const auto& cell : header_) widths.push_back(widthOf(cell));
  for (const auto& row : rows_)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], widthOf(row[i]));

  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string padding(widths[i] - widthOf(cells[i]), ' ');
      text += i == 0 ? cells[i] + padding : "  " + padding + cells[i];
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text + '\n';
  };
  std::size_t total = 2 * (widths.empty() ? 0 : widths.size() - 1);
  for (const std::size_t width : widths) total += width;
  std::string text = line(header_) + std::string(total, '-') + '\n';
  for (const auto& row : rows_) text += line(row);
  return text;
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return buffer;
}

}  // namespace s2s::eval
