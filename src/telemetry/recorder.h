// A recording: one MCAP file with everything a run decided on, and what it decided. docs/recording.md
// explains the topics.
//
//   Recorder recorder(new_recording_path("/var/lib/heel"), RecordingClock::wall());
//   recorder.record(tick);  recorder.record(pose);  recorder.record(event);
//   recorder.flush();       // at regular intervals: ends a chunk
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "heel/flow.h"
#include "mcap/mcap_writer.h"
#include "recording/picture.h"
#include "recording/records.h"
#include "recording/topics.h"
#include "telemetry/record_file.h"

namespace heel {

/// From the times of the records to those of the file's messages, which viewers show.
struct RecordingClock {
  TimeNs offset_ns = 0;
  /// The records have CLOCK_MONOTONIC; the file gets the time of the clock on the wall.
  static RecordingClock wall();
};

class Recorder {
 public:
  /// Creates the file. Throws heel::Error, which names it.
  Recorder(const std::string& path, RecordingClock clock);
  /// Writes the end of the file.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void record(const TickRecord& tick);
  void record(const PoseEstimate& pose);
  void record(const CaptureCounters& capture);
  void record(const Event& event);
  void record(const WireBytes& bytes);
  void record(const FrameTiming& timing);
  void record(const ConfigurationText& configuration);
  void record(const OperatorLine& line);
  void record(const RecordingNote& note);
  /// Bytes of any number.
  void record_wire(std::span<const std::uint8_t> bytes, bool to_robot, TimeNs t_ns);
  void record(const RecordedPicture& picture);
  /// A file that belongs to the recording. One that cannot be written is logged and counted.
  void attach(const std::string& name, const std::string& media_type, std::string_view content);
  /// A line of the log.
  void record_text(TimeNs t_ns, std::string_view text);

  /// Hands everything until now to the operating system.
  void flush();
  /// The same, and waits until the disk has it.
  void sync();

  /// Writes the end of the file and waits until the disk has it. Nothing may be recorded after it. False: the
  /// file lacks something.
  bool finish();

  const std::string& path() const { return file_.path(); }
  std::uint64_t bytes() const { return writer_.bytes(); }
  std::uint64_t messages() const { return writer_.messages(); }
  /// Messages and attachments.
  std::uint64_t records_lost() const { return writer_.messages_lost() + writer_.attachments_lost(); }

 private:
  void record_view(const TickRecord& tick);
  void write(Topic topic, TimeNs t_ns, std::string_view json);
  template <typename Flow>
  void write_flow(Topic topic, TimeNs t_ns, const Flow& record);

  const RecordingClock clock_;
  RecordFile file_;
  McapWriter writer_;
  std::array<std::uint16_t, kTopics> channels_{};
  std::string json_;  // of one message
};

/// The name of a new recording in the folder, by the date: "heel-20261130T052236Z.mcap", with a number when
/// there is one of that second. Makes the folder. Throws heel::Error naming telemetry.directory.
std::string new_recording_path(const std::string& folder, const std::string& suffix = "");

}  // namespace heel
