// A CSV file whose columns are functions: every row asks each of them for its value.
//
//   SampledCsv truth("truth.csv");
//   truth.add_column("person_x_m", 4, [&] { return person.x_m; });
//   truth.write_row();      // the first row brings the header
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "files/output_file.h"

namespace heel {

class SampledCsv {
 public:
  /// Throws heel::Error naming the file when it cannot be written; so do write_row() and flush().
  explicit SampledCsv(const std::string& path) : file_(path) {}

  /// `value` is called once for every row, in the order of the columns. All columns come before the first
  /// row.
  void add_column(const std::string& name, int decimals, std::function<double()> value);
  void write_row();
  void flush() { file_.flush(); }

 private:
  struct Column {
    std::string name;
    int decimals;
    std::function<double()> value;
  };

  OutputFile file_;
  std::vector<Column> columns_;
  bool has_header_ = false;
};

}  // namespace heel
