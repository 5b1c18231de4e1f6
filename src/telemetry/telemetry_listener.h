// What sees the records of a run as they come, in the telemetry thread: the live data of the page.
#pragma once

#include "heel/flow.h"

namespace heel {

/// No call may wait for anything.
class TelemetryListener {
 public:
  virtual ~TelemetryListener() = default;
  virtual void tick(const TickRecord& tick) = 0;
  virtual void pose(const PoseEstimate& pose) = 0;
  /// Before the pose of the same frame.
  virtual void marks(const PoseMarks&) {}
  virtual void event(const Event& event) = 0;
  /// False: frames are not even copied for it.
  virtual bool wants_pictures() = 0;
  /// Valid during the call only.
  virtual void picture(const FrameView& frame) = 0;
};

}  // namespace heel
