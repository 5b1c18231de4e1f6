// A camera over libcamera (0.0.3): the cameras of small computers, whose sensors V4L2 alone does not serve.
// Built only where libcamera is found (HEEL_HAVE_LIBCAMERA). The library completes requests in a thread of
// its own and allocates for each frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "capture/frame_source.h"

namespace heel {

class LibcameraSource final : public FrameSource {
 public:
  LibcameraSource(const std::string& id, const CameraConfig& config);
  ~LibcameraSource() override;

  OpenResult open() override;
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override;
  void close() override;

  /// No frame for this long: the camera has stalled, and only a new process may help.
  static constexpr TimeNs kStall_ns = 2 * kNsPerS;

 private:
  struct Session;
  OpenResult find_camera();
  OpenResult configure();
  OpenResult start();
  [[noreturn]] void give_up(const char* what);
  /// The frame of the request held.
  FrameResult deliver(TimeNs arrived_ns, FrameView& frame);

  std::string id_;
  CameraConfig config_;
  std::unique_ptr<Session> session_;
};

}  // namespace heel
