// Writing a CSV file cell by cell.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "files/output_file.h"

namespace heel {

/// A cell without a value, written as "nan".
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

class CsvFile {
 public:
  /// `header`: the columns' names, with commas between them. Throws heel::Error naming the file when it
  /// cannot be written; so do end_row() and flush().
  CsvFile(const std::string& path, std::string_view header);

  CsvFile& text(std::string_view cell);
  /// "nan" for what is not finite.
  CsvFile& number(double value, int decimals);
  CsvFile& count(std::size_t value);
  void end_row();
  /// Call it at the end, so that a full disk is reported.
  void flush() { file_.flush(); }

 private:
  OutputFile file_;
  std::string row_;
  bool row_is_empty_ = true;
};

}  // namespace heel
