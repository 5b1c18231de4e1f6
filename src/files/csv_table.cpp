#include "files/csv_table.h"

#include <cstdlib>
#include <fstream>

#include "heel/error.h"

namespace heel {
namespace {

/// The cells of a line, which may end as lines do on Windows.
std::vector<std::string> split(std::string line) {
  if (line.ends_with('\r')) line.pop_back();
  std::vector<std::string> cells;
  std::size_t from = 0;
  while (true) {
    const std::size_t comma = line.find(',', from);
    cells.push_back(line.substr(from, comma - from));
    if (comma == std::string::npos) return cells;
    from = comma + 1;
  }
}

}  // namespace

CsvTable::CsvTable(const std::string& path) : path_(path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line))
    throw Error(path + ": cannot read (expected a CSV file with a header line)");
  const std::vector<std::string> header = split(line);
  for (std::size_t i = 0; i < header.size(); ++i) columns_[header[i]] = i;
  while (std::getline(file, line) && !file.eof()) {
    cells_.push_back(split(line));
    if (cells_.back().size() != header.size())
      throw Error(place(cells_.size() - 1) + ": " + std::to_string(cells_.back().size()) +
                  " cells (expected " + std::to_string(header.size()) + " as in the header)");
  }
}

std::string CsvTable::place(std::size_t row) const {
  return path_ + ":" + std::to_string(row + 2);  // the header is line 1
}

const std::string& CsvTable::text(std::size_t row, const std::string& column) const {
  const auto found = columns_.find(column);
  if (found == columns_.end())
    throw Error(path_ + ": no column '" + column + "' (expected a file of this kind to have it)");
  return cells_[row][found->second];
}

double CsvTable::number(std::size_t row, const std::string& column) const {
  const std::string& cell = text(row, column);
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  if (end == cell.c_str() || *end != '\0')
    throw Error(place(row) + ": " + column + " is '" + cell.substr(0, 40) + "' (expected a number)");
  return value;
}

}  // namespace heel
