// Writing a CSV file of numbers, cell by cell.
#pragma once

#include <fstream>
#include <limits>
#include <string>
#include <string_view>

namespace heel::evaluation {

inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

class CsvFile {
 public:
  /// `header`: the columns' names, with commas between them.
  CsvFile(const std::string& path, std::string_view header);

  CsvFile& text(std::string_view cell);
  /// kNoValue is written as "nan".
  CsvFile& number(double value, int decimals);
  CsvFile& count(std::size_t value);
  void end_row();
  /// Throws heel::Error when the file could not be written whole.
  void close();

 private:
  std::string path_;
  std::ofstream file_;
  bool row_begun_ = false;
};

}  // namespace heel::evaluation
