// The queues through which the hot threads feed the telemetry thread: one writer each.
#pragma once

#include "heel/flow.h"
#include "realtime/record_queue.h"

namespace heel {

/// Capacities hold a stall of the telemetry thread of about five seconds.
struct TelemetryFeeds {
  RecordQueue<TickRecord> ticks{256};          ///< control thread
  RecordQueue<PoseEstimate> poses{256};        ///< vision thread
  RecordQueue<CaptureCounters> captures{256};  ///< capture thread
  RecordQueue<Event> capture_events{64};       ///< capture thread
  RecordQueue<Event> vision_events{64};        ///< vision thread
  RecordQueue<Event> control_events{64};       ///< control thread
};

}  // namespace heel
