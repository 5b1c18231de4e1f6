#include "files/csv_file.h"

#include <cmath>
#include <iterator>

namespace heel {

CsvFile::CsvFile(const std::string& path, std::string_view header) : file_(path) {
  file_.print("{}\n", header);
}

CsvFile& CsvFile::text(std::string_view cell) {
  if (!row_is_empty_) row_ += ',';
  row_is_empty_ = false;
  row_ += cell;
  return *this;
}

CsvFile& CsvFile::number(double value, int decimals) {
  if (!std::isfinite(value)) return text("nan");
  text("");
  fmt::format_to(std::back_inserter(row_), "{:.{}f}", value, decimals);
  return *this;
}

CsvFile& CsvFile::count(std::size_t value) {
  return text(std::to_string(value));
}

void CsvFile::end_row() {
  row_ += '\n';
  file_.write(row_);
  row_.clear();
  row_is_empty_ = true;
}

}  // namespace heel
