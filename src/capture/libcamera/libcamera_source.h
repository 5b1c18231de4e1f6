// A camera over libcamera 0.0.3, for the cameras of small computers, whose sensors V4L2 alone does not drive.
// Built only where libcamera is installed (HEEL_HAVE_LIBCAMERA). The library completes requests in a thread
// of its own and allocates memory for each frame.
#pragma once

#include <memory>
#include <string>

#include "capture/frame_source.h"
#include "core/config.h"

namespace heel {

class LibcameraSession;

class LibcameraSource final : public FrameSource {
 public:
  LibcameraSource(const std::string& id, const CameraConfig& config);
  ~LibcameraSource() override;

  OpenResult open() override;
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override;
  void close() override;

 private:
  OpenResult set_up();
  [[noreturn]] void abandon_session(const char* reason);
  FrameResult deliver_held_request(TimeNs arrived_ns, FrameView& frame);

  std::string id_;
  CameraConfig config_;
  std::unique_ptr<LibcameraSession> session_;
};

}  // namespace heel
