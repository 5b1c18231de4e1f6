// A recording: ticks.csv, poses.csv, capture.csv and events.log in one folder. src/telemetry/README.md
// explains the columns.
//
//   Recorder recorder("/var/lib/heel/run");
//   recorder.record(tick);  recorder.record(pose);  recorder.record(event);
//   recorder.flush();       // at regular intervals
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "heel/flow.h"
#include "telemetry/csv_line.h"
#include "telemetry/record_file.h"

namespace heel {

class Recorder {
 public:
  /// Creates the folder if it is missing, and renames the files of an earlier recording in it (ticks.csv
  /// becomes ticks.1.csv, or the first free number). Throws heel::Error, which names the file.
  explicit Recorder(const std::string& directory);

  void record(const TickRecord& tick);
  void record(const PoseEstimate& pose);
  void record(const CaptureCounters& capture);
  void record(const Event& event);
  /// Adds a line to events.log.
  void record_text(TimeNs t_ns, std::string_view text);
  void flush();

 private:
  CsvLine line_;
  std::unique_ptr<RecordFile> ticks_;
  std::unique_ptr<RecordFile> poses_;
  std::unique_ptr<RecordFile> capture_;
  std::unique_ptr<RecordFile> events_;
};

}  // namespace heel
