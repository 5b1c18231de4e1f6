// The queues through which the hot threads feed the telemetry thread: one writer each.
#pragma once

#include "heel/flow.h"
#include "realtime/spsc_queue.h"

namespace heel {

/// Capacities hold a stall of the telemetry thread of about five seconds.
struct TelemetryFeeds {
  SpscQueue<TickRecord> ticks{256};          ///< control thread
  SpscQueue<PoseEstimate> poses{256};        ///< vision thread
  SpscQueue<CaptureCounters> captures{256};  ///< capture thread
  SpscQueue<Event> capture_events{64};       ///< capture thread
  SpscQueue<Event> vision_events{64};        ///< vision thread
  SpscQueue<Event> control_events{64};       ///< control thread
};

}  // namespace heel
