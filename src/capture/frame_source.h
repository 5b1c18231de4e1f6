// The interface of all camera sources: V4L2 and libcamera devices, files, and the simulator. Used by the
// capture thread and by `heel teach --camera`.
//
//   auto source = open_frame_source(config.camera);          // capture/factory/frame_source_factory.h
//   FrameView frame;
//   while (source->wait_frame(kNsPerS, frame) == FrameResult::Frame) use(frame);
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "heel/flow.h"

namespace heel {

/// The outcome of waiting for a frame.
enum class FrameResult : std::uint8_t {
  Frame,        ///< a new frame
  Timeout,      ///< none yet; the source works
  Error,        ///< an unusable frame (corrupt, incomplete); counted; the next one may be good
  EndOfStream,  ///< a file's last frame has been given
  Lost,         ///< the device is gone or has stalled: close, and open again later
};
const char* to_string(FrameResult result);

/// The outcome of opening.
enum class OpenResult : std::uint8_t {
  Opened,
  Absent,   ///< not there now, but may appear (device unplugged, simulator not started)
  Refused,  ///< there, but it cannot do what is requested; problem() says what
};

/// Counted since construction; reopening does not reset them.
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

  /// Opens, also again after close(). Does not throw. Unless the result is Opened, problem() holds one line.
  virtual OpenResult open() = 0;
  /// Waits for the next frame, at most `timeout_ns`. The view is valid until the next call of any member.
  /// Throws heel::Error when only a new process can open the source again.
  virtual FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) = 0;
  virtual void close() = 0;

  /// The camera address, e.g. "v4l2:/dev/video0".
  const std::string& address() const { return address_; }
  /// One line: why the last open() failed, the source was lost or the frame is unusable.
  const std::string& problem() const { return problem_; }
  /// One line: format, size and rate; valid once opened.
  const std::string& description() const { return description_; }
  SourceCounters counters() const { return counters_; }

 protected:
  static constexpr const char* kDamagedText = "the driver marked the frame as damaged";

  /// Sets problem() and returns `result`. Allocates only when the text is longer than 256 bytes.
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
