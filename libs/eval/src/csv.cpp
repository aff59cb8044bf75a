#include "s2s/eval/csv.h"

#include <cmath>
#include <fstream>

#include "s2s/core/error.h"
#include "s2s/core/option_table.h"

namespace s2s::eval {

namespace {

/// What spreadsheets put before the first line of a table that they save as UTF-8.
const std::string kByteOrderMark = "\xEF\xBB\xBF";

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> values;
  std::size_t begin = 0;
  for (;;) {
    const auto comma = line.find(',', begin);
    values.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string::npos) return values;
    begin = comma + 1;
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

}  // namespace

CsvTable CsvTable::load(const std::string& path, const std::vector<std::string>& required) {
  std::ifstream file(path);
  if (!file)
    throw core::InputError("cannot read the table", path, "give a CSV file with the header " + joined(required));
  CsvTable table;
  table.path_ = path;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (number == 1 && line.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0)
      line.erase(0, kByteOrderMark.size());
    const std::string content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    std::vector<std::string> values = split(content);
    if (table.columns_.empty()) {
      for (std::size_t i = 0; i < values.size(); ++i) table.columns_.emplace(values[i], i);
      continue;
    }
    if (values.size() != table.columns_.size())
      throw core::InputError("the row has " + std::to_string(values.size()) + " values, the header " +
                                 std::to_string(table.columns_.size()),
                             path + ":" + std::to_string(number), "give each column of the header a value");
    table.rows_.push_back({number, std::move(values)});
  }
  for (const auto& column : required)
    if (!table.hasColumn(column))
      throw core::InputError("the table has no column '" + column + "'", path,
                             "begin the file with the header " + joined(required));
  return table;
}

const std::string& CsvTable::text(std::size_t row, const std::string& column) const {
  return rows_.at(row).values.at(columns_.at(column));
}

double CsvTable::number(std::size_t row, const std::string& column) const {
  double value = 0;
  if (!core::parseDouble(text(row, column), value) || !std::isfinite(value))
    throw core::InputError("'" + text(row, column) + "' in column '" + column + "' is no number", where(row),
                           "write a plain decimal number, metres for coordinates");
  return value;
}

std::string CsvTable::where(std::size_t row) const { return path_ + ":" + std::to_string(rows_.at(row).line); }

}  // namespace s2s::eval
