// Reads a recording: calls the visitor for each message, in the order of the file.
//
//   struct Ticks : RecordingVisitor { void on_tick(const TickRecord& tick) override { … } } visitor;
//   const RecordingReport report = read_recording(recording_in("/var/lib/heel"), visitor);
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "heel/flow.h"
#include "recording/picture.h"
#include "recording/records.h"

namespace heel {

class RecordingVisitor {
 public:
  virtual ~RecordingVisitor() = default;
  virtual void on_tick(const TickRecord& /*tick*/) {}
  virtual void on_pose(const PoseEstimate& /*pose*/) {}
  virtual void on_capture(const CaptureCounters& /*counters*/) {}
  virtual void on_event(const Event& /*event*/) {}
  virtual void on_wire(const WireBytes& /*bytes*/) {}
  virtual void on_timing(const FrameTiming& /*timing*/) {}
  virtual void on_log(const LogLine& /*line*/) {}
  virtual void on_configuration(const ConfigurationText& /*configuration*/) {}
  virtual void on_operator(const OperatorLine& /*line*/) {}
  virtual void on_note(const RecordingNote& /*note*/) {}
  virtual void on_picture(const RecordedPicture& /*picture*/) {}
  /// Topics that are not wanted are skipped, which is quicker. All by default.
  virtual bool wants(std::string_view /*topic*/) const { return true; }
};

struct RecordingReport {
  std::string file;
  std::uint64_t messages = 0;                      ///< that the visitor got
  bool complete = false;                           ///< the recording was closed, not cut off
  std::map<std::string, std::string> attachments;  ///< name and content of files
  std::vector<std::string> problems;               ///< damage, one line each, with the place
  /// Fields that this version has and the recording does not, or the other way, as "/heel/tick.target.x_m".
  std::set<std::string> other_version;
};

/// Throws heel::Error when the file cannot be read, is no MCAP file, or holds a message that is none of ours.
RecordingReport read_recording(const std::string& file, RecordingVisitor& visitor);

/// Throws heel::Error when the file cannot be read or does not begin as an MCAP file does.
void require_recording(const std::string& file);

/// The recording that a person means: the file itself, or the newest recording of a folder. Throws
/// heel::Error when there is none.
std::string recording_in(const std::string& file_or_folder);

inline constexpr const char* kRecordingExtension = ".mcap";

}  // namespace heel
