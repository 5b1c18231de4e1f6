#include "recording/csv_export.h"

#include "files/folder.h"
#include "files/output_file.h"
#include "recording/csv_columns.h"

namespace heel {
namespace {

class CsvExporter final : public RecordingVisitor {
 public:
  explicit CsvExporter(const std::string& folder)
      : ticks_(folder + "/ticks.csv"),
        poses_(folder + "/poses.csv"),
        capture_(folder + "/capture.csv"),
        events_(folder + "/events.log") {
    ticks_.write(csv_header(tick_columns()));
    poses_.write(csv_header(pose_columns()));
    capture_.write(csv_header(capture_columns()));
  }

  void on_tick(const TickRecord& tick) override { ticks_.write(csv_row(line_, tick_columns(), tick)); }
  void on_pose(const PoseEstimate& pose) override { poses_.write(csv_row(line_, pose_columns(), pose)); }
  void on_capture(const CaptureCounters& counters) override {
    capture_.write(csv_row(line_, capture_columns(), counters));
  }
  void on_log(const LogLine& line) override {
    line_.clear();
    line_.seconds(line.t_ns);
    std::string whole(line_.finish());
    whole.back() = ' ';
    events_.write(whole.append(line.text) + '\n');
  }
  bool wants(std::string_view topic) const override {
    return topic == "/heel/tick" || topic == "/heel/pose" || topic == "/heel/capture" || topic == "/log";
  }
  void flush() {
    for (OutputFile* file : {&ticks_, &poses_, &capture_, &events_}) file->flush();
  }

 private:
  OutputFile ticks_, poses_, capture_, events_;
  CsvLine line_;
};

}  // namespace

RecordingReport export_csv(const std::string& recording, const std::string& folder) {
  require_recording(recording);  // before files of an earlier one are replaced
  make_folder(folder);
  CsvExporter exporter(folder);
  RecordingReport report = read_recording(recording, exporter);
  exporter.flush();
  return report;
}

}  // namespace heel
