// An open libcamera camera: everything that lives from open() to close(), and how it is set up.
#pragma once

#include <libcamera/libcamera.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "capture/driver_sequence.h"
#include "capture/frame_source.h"
#include "capture/luma_converter.h"
#include "capture/stall_watch.h"
#include "core/config.h"
#include "realtime/spsc_queue.h"

namespace heel {

class LibcameraSession {
 public:
  LibcameraSession() = default;
  ~LibcameraSession();
  LibcameraSession(const LibcameraSession&) = delete;
  LibcameraSession& operator=(const LibcameraSession&) = delete;

  // Set-up, in this order. Unless the result is Opened, problem() holds one line.
  OpenResult find_camera(const std::string& id);
  OpenResult configure(const CameraConfig& config);
  OpenResult start(const CameraConfig& config);

  const std::string& problem() const { return problem_; }
  /// The agreed format and size; valid after configure().
  std::string description() const { return stream().toString(); }

  /// Waits for a completed request, at most `timeout_ns`; null: none. The caller gives it back with queue().
  libcamera::Request* wait_completed(TimeNs timeout_ns);
  /// Hands a request to the camera again. False: the camera takes none.
  bool queue(libcamera::Request& request);
  bool disconnected() const { return disconnected_.load(std::memory_order_acquire); }
  /// Converts the frame of a completed request and sets the image of `frame`. False: converter().problem()
  /// says why.
  bool convert(const libcamera::FrameBuffer& buffer, FrameView& frame);
  const LumaConverter& converter() const { return converter_; }

  DriverSequence sequence;
  libcamera::Request* held = nullptr;  ///< its buffer is in use until the next wait_frame()
  StallWatch stall;

 private:
  /// The first plane of a buffer (the luma), mapped.
  struct Mapping {
    const libcamera::FrameBuffer* buffer = nullptr;
    void* memory = nullptr;
    std::size_t mapped_bytes = 0;
    std::size_t offset = 0;
    std::size_t bytes = 0;

    const std::uint8_t* data() const { return static_cast<const std::uint8_t*>(memory) + offset; }
  };

  const libcamera::StreamConfiguration& stream() const { return configuration_->at(0); }
  OpenResult choose_format(const CameraConfig& config);
  OpenResult map_buffers();
  OpenResult set_controls(const CameraConfig& config, libcamera::ControlList& controls);
  void on_completed(libcamera::Request* request);  // in libcamera's thread
  void on_disconnected();                          // in libcamera's thread
  OpenResult fail(OpenResult result, std::string problem);

  std::string problem_;
  libcamera::CameraManager manager_;
  bool manager_started_ = false;
  std::shared_ptr<libcamera::Camera> camera_;
  bool acquired_ = false;
  bool started_ = false;
  std::unique_ptr<libcamera::CameraConfiguration> configuration_;
  std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
  std::vector<std::unique_ptr<libcamera::Request>> requests_;
  std::vector<Mapping> mappings_;
  LumaConverter converter_;

  static constexpr unsigned kBuffers = 4;
  SpscQueue<libcamera::Request*> completed_{2 * kBuffers};
  std::atomic<std::uint32_t> signal_{0};  // changes with every completed request and the disconnection
  std::atomic<bool> disconnected_{false};
};

}  // namespace heel
