#include "capture/libcamera/libcamera_source.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "capture/libcamera/libcamera_session.h"
#include "heel/error.h"
#include "realtime/clock.h"

namespace heel {

LibcameraSource::LibcameraSource(const std::string& id, const CameraConfig& config)
    : FrameSource("libcamera:" + id), id_(id), config_(config) {}

LibcameraSource::~LibcameraSource() = default;

OpenResult LibcameraSource::open() {
  close();
  session_ = std::make_unique<LibcameraSession>();
  const OpenResult result = set_up();
  if (result != OpenResult::Opened) close();
  return result;
}

OpenResult LibcameraSource::set_up() {
  LibcameraSession& s = *session_;
  OpenResult result = s.find_camera(id_);
  if (result == OpenResult::Opened) result = s.configure(config_);
  if (result == OpenResult::Opened) result = s.start(config_);
  if (result != OpenResult::Opened) return fail(result, s.problem());
  description_ = address_ + ": " + s.description();
  return result;
}

FrameResult LibcameraSource::wait_frame(TimeNs timeout_ns, FrameView& frame) {
  if (!session_) return fail(FrameResult::Lost, "is not open");
  LibcameraSession& s = *session_;
  if (libcamera::Request* const returned = std::exchange(s.held, nullptr)) {
    if (!s.queue(*returned)) abandon_session("takes no request back");
  }
  s.held = s.wait_completed(timeout_ns);
  if (s.disconnected()) abandon_session("the camera is gone");
  const TimeNs now_ns = monotonic_now_ns();
  if (s.held == nullptr) {
    if (s.stall.stalled(now_ns))
      abandon_session(fmt::format("no frame for {} s", s.stall.allowed_ns() / kNsPerS).c_str());
    return FrameResult::Timeout;
  }
  s.stall.frame(now_ns);
  if (s.held->status() == libcamera::Request::RequestCancelled) abandon_session("a request was cancelled");
  return deliver_held_request(now_ns, frame);
}

/// libcamera 0.0.3 aborts the program when a camera that is gone is stopped (an assertion in
/// PipelineHandler::stop), and does not always report that a camera is gone. Therefore the session of a
/// failed camera is never destroyed, and the program must end in order and be started again, as systemd does.
void LibcameraSource::abandon_session(const char* reason) {
  static auto* const abandoned = new std::vector<std::unique_ptr<LibcameraSession>>;  // also kept at exit
  abandoned->push_back(std::move(session_));
  throw Error(
      fmt::format("{}: {}; libcamera can open a failed camera only in a new process: restart the program",
                  address_, reason));
}

FrameResult LibcameraSource::deliver_held_request(TimeNs arrived_ns, FrameView& frame) {
  LibcameraSession& s = *session_;
  const libcamera::FrameBuffer& buffer = *s.held->buffers().begin()->second;
  const libcamera::FrameMetadata& metadata = buffer.metadata();
  s.sequence.advance(metadata.sequence);
  counters_.dropped_by_driver += s.sequence.gap();
  if (metadata.status != libcamera::FrameMetadata::FrameSuccess) {
    ++counters_.dropped_by_driver;
    return fail(FrameResult::Error, kDamagedText);
  }
  const auto stamp_ns = static_cast<TimeNs>(metadata.timestamp);
  frame.header = {.sequence = s.sequence.sequence(),
                  .t_capture_ns = is_plausible_stamp(stamp_ns, arrived_ns) ? stamp_ns : arrived_ns,
                  .width_px = static_cast<std::uint32_t>(config_.width_px),
                  .height_px = static_cast<std::uint32_t>(config_.height_px)};
  if (s.convert(buffer, frame)) return FrameResult::Frame;
  ++counters_.corrupt;
  return fail(FrameResult::Error, s.converter().problem());
}

void LibcameraSource::close() {
  session_.reset();
}

}  // namespace heel
