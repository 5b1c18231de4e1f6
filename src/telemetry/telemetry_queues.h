// The queues from the real-time threads to the telemetry thread; each has one writer.
#pragma once

#include "heel/flow.h"
#include "realtime/spsc_queue.h"

namespace heel {

/// They hold what comes while the telemetry thread is stopped for about five seconds.
struct TelemetryQueues {
  SpscQueue<TickRecord> ticks{256};          ///< control thread
  SpscQueue<PoseEstimate> poses{256};        ///< vision thread
  SpscQueue<PoseMarks> marks{16};            ///< vision thread; only for who looks: it may lose some
  SpscQueue<FrameTiming> timings{256};       ///< vision thread
  SpscQueue<CaptureCounters> captures{256};  ///< capture thread
  SpscQueue<Event> capture_events{64};       ///< capture thread
  SpscQueue<Event> control_events{64};       ///< control thread
  SpscQueue<WireBytes> wire{1024};           ///< control thread; the robot's line
};

}  // namespace heel
