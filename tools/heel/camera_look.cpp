#include "camera_look.h"

#include "capture/factory/frame_source_factory.h"
#include "heel/error.h"
#include "preflight_step.h"
#include "realtime/clock.h"

namespace heel::cli {
namespace {

constexpr TimeNs kFirstFrame_ns = 16 * kNsPerS;  // as patient as heeld is with a camera that was never heard

}  // namespace

Look::Look(const CameraConfig& config) : source_(open_frame_source(config)) {}

void Look::take(const std::function<void(const FrameView&)>& use, TimeNs longest_ns,
                const std::function<bool()>& goes_on) {
  FrameView frame;
  TimeNs end_ns = monotonic_now_ns() + kFirstFrame_ns;
  while (monotonic_now_ns() < end_ns && !g_preflight_interrupted && goes_on()) {
    const FrameResult result = source_->wait_frame(kNsPerS / 10, frame);
    if (result == FrameResult::EndOfStream) break;
    if (result == FrameResult::Lost) throw Error(source_->problem());
    if (result != FrameResult::Frame) continue;
    if (frames_++ == 0) {
      t_first_ns_ = frame.header.t_capture_ns;
      end_ns = monotonic_now_ns() + longest_ns;
    }
    t_last_ns_ = frame.header.t_capture_ns;
    width_px_ = static_cast<int>(frame.header.width_px);
    height_px_ = static_cast<int>(frame.header.height_px);
    use(frame);
  }
  if (frames_ == 0)
    throw Error(source_->problem().empty() ? source_->address() + ": no picture came" : source_->problem());
}

double Look::rate_hz() const {
  const double s = seconds_from_ns(t_last_ns_ - t_first_ns_);
  return s > 0.0 ? static_cast<double>(frames_ - 1) / s : 0.0;
}

double Look::damaged_share() const {
  const auto damaged = static_cast<double>(source_->counters().corrupt);
  return damaged / (damaged + static_cast<double>(frames_));
}

}  // namespace heel::cli
