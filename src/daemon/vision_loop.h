// The loop of the vision thread: takes the newest frame, estimates its pose, and hands it to control and
// telemetry.
#pragma once

#include <atomic>

#include "heel/flow.h"
#include "realtime/frame_triple_buffer.h"
#include "realtime/mailbox.h"
#include "realtime/picture_queue.h"
#include "telemetry/telemetry_queues.h"
#include "vision/pose/template_selector.h"

namespace heel {

class VisionLoop {
 public:
  /// Everything is borrowed and must outlive run(). `pictures`, where given, gets a copy of every frame after
  /// its pose has gone out.
  VisionLoop(FrameTripleBuffer& frames, TemplateSelector& templates, Mailbox<PoseEstimate>& to_control,
             TelemetryQueues& to_telemetry, PictureQueue* pictures = nullptr);

  /// Runs until stop(). Does not allocate, lock or format.
  void run();
  /// From any thread.
  void stop();

 private:
  FrameTripleBuffer& frames_;
  TemplateSelector& templates_;
  Mailbox<PoseEstimate>& to_control_;
  TelemetryQueues& to_telemetry_;
  PictureQueue* const pictures_;
  std::atomic<bool> stop_{false};
};

}  // namespace heel
