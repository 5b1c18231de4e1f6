// The truth as CSV: one row a moment, columns contributed by whoever knows them.
//
//   TruthCsv truth("truth.csv");
//   add_robot_columns(truth, robot);
//   truth.column("person_x_m", 4, [&] { return person.x_m(); });
//   truth.write_row();      // the first call writes the header
#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/robot/p3at.h"

namespace heel::sim {

class TruthCsv {
 public:
  /// Throws heel::Error when the file cannot be written.
  explicit TruthCsv(const std::string& path);

  /// All columns must be added before the first row. `value` is asked at every row.
  void column(const std::string& name, int decimals, std::function<double()> value);
  /// Throws heel::Error when the disk is full or the file has gone.
  void write_row();

 private:
  struct Column {
    std::string name;
    int decimals;
    std::function<double()> value;
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<Column> columns_;
  bool has_header_ = false;
};

/// t_s; true pose and speed; odometry as the firmware has it; wheels; session, motors, watchdog, stall,
/// bumpers, STOP button. `robot` must outlive `truth`.
void add_robot_columns(TruthCsv& truth, const P3At& robot);

}  // namespace heel::sim
