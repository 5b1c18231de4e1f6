// The last 30 s of ticks, poses, events and bytes on the wire in a mapped file, which outlives the process:
// after a crash, a SIGKILL or the watchdog's restart the next start of heeld makes a recording of it. A file
// on a tmpfs costs no disk access.
//
//   BlackBox box("/run/heel/black-box", RecordingClock::wall());   box.add(tick); …   box.end();
//   recover_black_box("/run/heel/black-box", "/var/lib/heel/heel-….mcap");   // before, at the start
#pragma once

#include <cstdint>
#include <string>

#include "heel/flow.h"
#include "telemetry/recorder.h"

namespace heel {

class BlackBox {
 public:
  /// Creates the file, or empties it. Throws heel::Error naming it when it cannot be mapped, another heeld
  /// uses it, or it is a file of another kind, which stays as it is.
  BlackBox(const std::string& path, RecordingClock clock);
  ~BlackBox();
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;

  void add(const TickRecord& tick);
  void add(const PoseEstimate& pose);
  void add(const Event& event);
  void add(const WireBytes& bytes);
  void add(const ConfigurationText& configuration);  ///< the newest is kept

  /// Writes everything that it holds into a recording, in place of one of that name. Throws heel::Error.
  void save(const std::string& recording) const;
  /// The run ends by itself: there is nothing to recover.
  void end();

 private:
  struct Contents;
  friend bool recover_black_box(const std::string& path, const std::string& recording);

  const std::string path_;
  int fd_ = -1;
  Contents* contents_ = nullptr;
};

/// What a heeld that did not end by itself has left, as a recording, in place of one of that name. False:
/// nothing has been left. Throws heel::Error when the recording cannot be written, or the file is one of
/// another build of heel.
bool recover_black_box(const std::string& path, const std::string& recording);

}  // namespace heel
