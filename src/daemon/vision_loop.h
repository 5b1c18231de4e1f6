// The vision thread's body: the freshest frame in, its pose to control and to the recording.
#pragma once

#include <atomic>

#include "heel/pose_tracker.h"
#include "realtime/frame_ring.h"
#include "realtime/mailbox.h"
#include "realtime/record_queue.h"

namespace heel {

class VisionLoop {
 public:
  /// Everything is borrowed and must outlive run().
  VisionLoop(FrameRing& frames, PoseTracker& tracker, Mailbox<PoseEstimate>& to_control,
             RecordQueue<PoseEstimate>& to_telemetry);

  /// Until stop(). Does not allocate, lock or format.
  void run();
  /// From any thread.
  void stop();

 private:
  FrameRing& frames_;
  PoseTracker& tracker_;
  Mailbox<PoseEstimate>& to_control_;
  RecordQueue<PoseEstimate>& to_telemetry_;
  std::atomic<bool> stop_{false};
};

}  // namespace heel
