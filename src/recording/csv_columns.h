// The columns of ticks.csv, poses.csv and capture.csv. Each file's header and rows are made from one table; a
// test compares src/telemetry/README.md with it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "heel/flow.h"
#include "recording/csv_line.h"

namespace heel {

template <typename Record>
struct CsvColumn {
  std::string name;
  void (*write)(CsvLine& line, const Record& record, int index);
  int index = 0;  ///< passed to `write`: the element of an array
};

std::span<const CsvColumn<TickRecord>> tick_columns();
std::span<const CsvColumn<PoseEstimate>> pose_columns();
std::span<const CsvColumn<CaptureCounters>> capture_columns();

/// The column names, separated by commas, with a line end.
template <typename Record>
std::string csv_header(std::span<const CsvColumn<Record>> columns) {
  std::string header;
  for (const CsvColumn<Record>& column : columns) header += (header.empty() ? "" : ",") + column.name;
  return header + '\n';
}

/// The record as one line; valid until `line` is used again.
template <typename Record>
std::string_view csv_row(CsvLine& line, std::span<const CsvColumn<Record>> columns, const Record& record) {
  line.clear();
  for (const CsvColumn<Record>& column : columns) column.write(line, record, column.index);
  return line.finish();
}

}  // namespace heel
