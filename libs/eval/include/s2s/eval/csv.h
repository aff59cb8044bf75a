#pragma once

#include <map>
#include <string>
#include <vector>

namespace s2s::eval {

/// A table of comma-separated values with a header line. Blank lines and lines starting with `#` are skipped, blanks
/// around a value are dropped; quoting is not supported.
class CsvTable {
 public:
  /// @throws core::InputError if the file is missing, empty, lacks one of the `required` columns, or a row has
  /// another number of values than the header
  static CsvTable load(const std::string& path, const std::vector<std::string>& required);

  std::size_t rows() const { return rows_.size(); }
  bool hasColumn(const std::string& column) const { return columns_.count(column) != 0; }
  /// @pre the column exists and `row` < rows()
  const std::string& text(std::size_t row, const std::string& column) const;
  /// @throws core::InputError naming file, line and value if the value is no finite number
  double number(std::size_t row, const std::string& column) const;
  /// "file.csv:3", for messages.
  std::string where(std::size_t row) const;

 private:
  struct Row {
    int line = 0;
    std::vector<std::string> values;
  };
  std::string path_;
  std::map<std::string, std::size_t> columns_;
  std::vector<Row> rows_;
};

}  // namespace s2s::eval
