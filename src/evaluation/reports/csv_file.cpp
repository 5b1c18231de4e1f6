#include "evaluation/reports/csv_file.h"

#include <cmath>
#include <cstdio>

#include "heel/error.h"

namespace heel::evaluation {

CsvFile::CsvFile(const std::string& path, std::string_view header) : path_(path), file_(path) {
  file_ << header << '\n';
}

CsvFile& CsvFile::text(std::string_view cell) {
  if (row_begun_) file_ << ',';
  row_begun_ = true;
  file_ << cell;
  return *this;
}

CsvFile& CsvFile::number(double value, int decimals) {
  if (!std::isfinite(value)) return text("nan");
  char cell[64];
  std::snprintf(cell, sizeof cell, "%.*f", decimals, value);
  return text(cell);
}

CsvFile& CsvFile::count(std::size_t value) {
  return text(std::to_string(value));
}

void CsvFile::end_row() {
  file_ << '\n';
  row_begun_ = false;
}

void CsvFile::close() {
  if (!file_.flush()) throw Error(path_ + ": cannot write (expected a writable folder)");
}

}  // namespace heel::evaluation
