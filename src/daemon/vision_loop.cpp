#include "daemon/vision_loop.h"

#include "realtime/clock.h"
#include "realtime/hot_section.h"

namespace heel {

namespace {
constexpr TimeNs kLongestWait_ns = 100 * kNsPerMs;  // stop() takes effect within it
}

VisionLoop::VisionLoop(FrameTripleBuffer& frames, TemplateSelector& templates,
                       Mailbox<PoseEstimate>& to_control, TelemetryQueues& to_telemetry,
                       PictureQueue* pictures)
    : frames_(frames),
      templates_(templates),
      to_control_(to_control),
      to_telemetry_(to_telemetry),
      pictures_(pictures) {}

void VisionLoop::run() {
  const HotSection hot;
  while (!stop_.load(std::memory_order_relaxed)) {
    if (!frames_.wait(kLongestWait_ns)) continue;
    const FrameView* frame = frames_.take();
    if (frame == nullptr) continue;
    const TimeNs t_vision_ns = monotonic_now_ns();
    PoseEstimate pose = templates_.estimate(*frame);
    pose.t_done_ns = monotonic_now_ns();
    to_control_.post(pose);
    to_telemetry_.marks.push(templates_.marks(pose.template_index));  // before the pose that they belong to
    to_telemetry_.poses.push(pose);
    const FrameHeader& header = frame->header;
    to_telemetry_.timings.push(
        {header.sequence, header.t_capture_ns, header.t_dequeued_ns, t_vision_ns, pose.t_done_ns});
    if (pictures_ != nullptr) pictures_->push(*frame);
  }
}

void VisionLoop::stop() {
  stop_.store(true, std::memory_order_relaxed);
  frames_.wake();
}

}  // namespace heel
