// Where frames come from: a V4L2 or libcamera device, files, or the simulator. One interface for the capture
// thread and for `heel teach --camera`.
//
//   auto source = open_frame_source(config.camera);          // frame_source_factory.h
//   FrameView frame;
//   while (source->wait_frame(kNsPerS, frame) == FrameResult::Frame) use(frame);
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "heel/flow.h"

namespace heel {

/// What became of waiting for a frame.
enum class FrameResult : std::uint8_t {
  Frame,        ///< a new frame
  Timeout,      ///< none yet; the source is well
  Error,        ///< a frame came but is unusable (corrupt, incomplete); counted, the next may be good
  EndOfStream,  ///< a file's last frame has been given
  Lost,         ///< the device has gone or stalled: close, and open again later
};
const char* to_string(FrameResult result);

/// What became of opening.
enum class OpenResult : std::uint8_t {
  Opened,
  Absent,   ///< not there now; it may come (device unplugged, simulator not started)
  Refused,  ///< there, but it cannot do what is asked; problem() says what
};

/// Counted since construction, across reopenings.
struct SourceCounters {
  std::uint64_t dropped_by_driver = 0;  ///< gaps in the driver's sequence, buffers with its error flag
  std::uint64_t corrupt = 0;            ///< frames that could not be decoded
};

class FrameSource {
 public:
  explicit FrameSource(std::string address) : address_(std::move(address)) { problem_.reserve(256); }
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  /// Opens, also again after close(). Does not throw; problem() holds one line unless Opened.
  virtual OpenResult open() = 0;
  /// Waits for the next frame, at most `timeout_ns`. The view is valid until the next call of any member.
  /// Throws heel::Error when this program can never open the source again.
  virtual FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) = 0;
  virtual void close() = 0;

  /// The camera address, e.g. "v4l2:/dev/video0".
  const std::string& address() const { return address_; }
  /// One line: why the last open() failed, the source was lost or the frame is unusable.
  const std::string& problem() const { return problem_; }
  /// One line: what was agreed with the device; valid once opened.
  const std::string& description() const { return description_; }
  SourceCounters counters() const { return counters_; }

 protected:
  /// Sets problem() and passes the result on. Allocates only when the text is longer than any before it.
  template <typename Result>
  Result fail(Result result, std::string_view what) {
    problem_.assign(address_).append(": ").append(what);
    return result;
  }

  std::string address_;
  std::string problem_;
  std::string description_;
  SourceCounters counters_;
};

}  // namespace heel
