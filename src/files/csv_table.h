// A CSV file with one header line, columns by name.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

namespace heel {

class CsvTable {
 public:
  /// A last line without its end is left out: a run that was cut short. Throws heel::Error naming the file,
  /// and the line that does not have as many cells as the header.
  explicit CsvTable(const std::string& path);

  std::size_t rows() const { return cells_.size(); }
  /// "file:line" of a row.
  std::string place(std::size_t row) const;
  bool has(const std::string& column) const { return columns_.contains(column); }
  /// Throws heel::Error naming file, line and column where the cell is no number ("nan" is one).
  double number(std::size_t row, const std::string& column) const;
  /// Throws heel::Error naming file and column where there is no such column.
  const std::string& text(std::size_t row, const std::string& column) const;

 private:
  std::string path_;
  std::unordered_map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace heel
