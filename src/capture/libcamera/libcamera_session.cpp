#include "capture/libcamera/libcamera_session.h"

#include <sys/mman.h>

#include <utility>

#include "realtime/futex.h"

namespace heel {

LibcameraSession::~LibcameraSession() {
  if (started_) camera_->stop();
  if (camera_) {
    camera_->requestCompleted.disconnect(this);
    camera_->disconnected.disconnect(this);
  }
  for (const Mapping& mapping : mappings_) munmap(mapping.memory, mapping.mapped_bytes);
  requests_.clear();
  allocator_.reset();
  if (acquired_) camera_->release();
  camera_.reset();
  if (manager_started_) manager_.stop();
}

libcamera::Request* LibcameraSession::wait_completed(TimeNs timeout_ns) {
  libcamera::Request* request = nullptr;
  const std::uint32_t seen = signal_.load(std::memory_order_acquire);
  if (completed_.pop(request)) return request;
  futex_wait(signal_, seen, timeout_ns, FutexScope::Process);
  return completed_.pop(request) ? request : nullptr;
}

bool LibcameraSession::queue(libcamera::Request& request) {
  request.reuse(libcamera::Request::ReuseBuffers);
  return camera_->queueRequest(&request) == 0;
}

bool LibcameraSession::convert(const libcamera::FrameBuffer& buffer, FrameView& frame) {
  const libcamera::FrameMetadata& metadata = buffer.metadata();
  const std::size_t used_bytes = metadata.planes().empty() ? 0 : metadata.planes()[0].bytesused;
  for (const Mapping& mapping : mappings_) {
    if (mapping.buffer != &buffer) continue;
    return converter_.convert(mapping.data(), used_bytes, mapping.bytes, frame);
  }
  return converter_.convert(nullptr, 0, 0, frame);  // an unknown buffer counts as too short
}

void LibcameraSession::on_completed(libcamera::Request* request) {
  completed_.push(request);
  signal_.fetch_add(1, std::memory_order_release);
  futex_wake_all(signal_, FutexScope::Process);
}

void LibcameraSession::on_disconnected() {
  disconnected_.store(true, std::memory_order_release);
  signal_.fetch_add(1, std::memory_order_release);
  futex_wake_all(signal_, FutexScope::Process);
}

OpenResult LibcameraSession::fail(OpenResult result, std::string problem) {
  problem_ = std::move(problem);
  return result;
}

}  // namespace heel
