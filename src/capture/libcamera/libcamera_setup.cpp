// The set-up of a LibcameraSession: camera, format, buffers, controls.
#include <fmt/format.h>
#include <sys/mman.h>

#include <array>
#include <cstring>

#include "capture/libcamera/libcamera_session.h"
#include "realtime/clock.h"

namespace heel {
namespace {

namespace controls = libcamera::controls;

libcamera::PixelFormat library_format(PixelFormat format) {
  switch (format) {
    case PixelFormat::Grey:
      return libcamera::formats::R8;
    case PixelFormat::Nv12:
      return libcamera::formats::NV12;
    case PixelFormat::Yuyv:
      return libcamera::formats::YUYV;
    // libcamera names them as DRM does, from the highest byte of a little-endian word down.
    case PixelFormat::Rgb3:
      return libcamera::formats::BGR888;
    case PixelFormat::Bgr3:
      return libcamera::formats::RGB888;
    case PixelFormat::Mjpg:
      break;
  }
  return libcamera::formats::MJPEG;
}

bool has(const libcamera::ControlInfoMap& known, const libcamera::ControlId& control) {
  return known.count(control.id()) != 0;
}

}  // namespace

OpenResult LibcameraSession::find_camera(const std::string& id) {
  if (const int error = manager_.start(); error != 0) {
    return fail(OpenResult::Refused, fmt::format("libcamera does not start: {}", std::strerror(-error)));
  }
  manager_started_ = true;
  camera_ = manager_.get(id);
  if (!camera_) {
    std::string known;
    for (const auto& camera : manager_.cameras()) known += (known.empty() ? "" : ", ") + camera->id();
    return fail(OpenResult::Absent, fmt::format("libcamera knows no camera of this id; it knows {}",
                                                known.empty() ? "none" : known));
  }
  if (const int error = camera_->acquire(); error != 0) {
    return fail(OpenResult::Absent, fmt::format("cannot be acquired: {}", std::strerror(-error)));
  }
  acquired_ = true;
  return OpenResult::Opened;
}

OpenResult LibcameraSession::configure(const CameraConfig& config) {
  configuration_ = camera_->generateConfiguration({libcamera::StreamRole::Viewfinder});
  if (!configuration_ || configuration_->empty()) return fail(OpenResult::Refused, "offers no stream");
  if (const OpenResult chosen = choose_format(config); chosen != OpenResult::Opened) return chosen;
  if (const int error = camera_->configure(configuration_.get()); error != 0) {
    return fail(OpenResult::Refused, fmt::format("cannot be configured: {}", std::strerror(-error)));
  }
  return map_buffers();
}

OpenResult LibcameraSession::choose_format(const CameraConfig& config) {
  libcamera::StreamConfiguration& wanted = configuration_->at(0);
  const libcamera::Size size(static_cast<unsigned>(config.width_px), static_cast<unsigned>(config.height_px));
  PixelFormat only = PixelFormat::Grey;
  const bool named = parse_pixel_format(config.format, only);
  for (const PixelFormat candidate : pixel_formats()) {
    if (named && candidate != only) continue;
    wanted.pixelFormat = library_format(candidate);
    wanted.size = size;
    wanted.bufferCount = kBuffers;
    const bool valid = configuration_->validate() != libcamera::CameraConfiguration::Invalid;
    if (!valid || wanted.pixelFormat != library_format(candidate) || wanted.size != size) continue;
    converter_.configure(candidate, size.width, size.height, wanted.stride);
    return OpenResult::Opened;
  }
  return fail(OpenResult::Refused,
              fmt::format("does not give {} as {} (expected a size and format that it has; nearest: {})",
                          size.toString(), config.format, wanted.toString()));
}

OpenResult LibcameraSession::map_buffers() {
  libcamera::Stream* const stream = configuration_->at(0).stream();
  allocator_ = std::make_unique<libcamera::FrameBufferAllocator>(camera_);
  if (allocator_->allocate(stream) < 0) return fail(OpenResult::Refused, "gives no buffers");
  for (const auto& buffer : allocator_->buffers(stream)) {
    const libcamera::FrameBuffer::Plane& plane = buffer->planes().front();
    Mapping mapping{.buffer = buffer.get(), .offset = plane.offset, .bytes = plane.length};
    mapping.mapped_bytes = mapping.offset + mapping.bytes;
    mapping.memory = mmap(nullptr, mapping.mapped_bytes, PROT_READ, MAP_SHARED, plane.fd.get(), 0);
    if (mapping.memory == MAP_FAILED) return fail(OpenResult::Refused, "its buffers cannot be mapped");
    mappings_.push_back(mapping);
    std::unique_ptr<libcamera::Request> request = camera_->createRequest();
    if (!request || request->addBuffer(stream, buffer.get()) != 0) {
      return fail(OpenResult::Refused, "takes no requests");
    }
    requests_.push_back(std::move(request));
  }
  return OpenResult::Opened;
}

OpenResult LibcameraSession::set_controls(const CameraConfig& config, libcamera::ControlList& list) {
  const libcamera::ControlInfoMap& known = camera_->controls();
  const auto missing = [this](const char* key, const char* what, const char* expected) {
    return fail(OpenResult::Refused,
                fmt::format("{}: the camera has no control of its {} (expected {})", key, what, expected));
  };
  if (has(known, controls::FrameDurationLimits) && config.rate_hz > 0.0) {
    const auto period_us = static_cast<std::int64_t>(1e6 / config.rate_hz);
    const std::array<std::int64_t, 2> limits{period_us, period_us};
    list.set(controls::FrameDurationLimits, libcamera::Span<const std::int64_t, 2>(limits));
  }
  if (config.exposure_ms > 0.0) {
    if (!has(known, controls::ExposureTime)) return missing("camera.exposure_ms", "exposure", "0");
    if (has(known, controls::AeEnable)) list.set(controls::AeEnable, false);
    list.set(controls::ExposureTime, static_cast<std::int32_t>(config.exposure_ms * 1e3));
  }
  if (config.gain >= 0.0) {
    if (!has(known, controls::AnalogueGain)) return missing("camera.gain", "gain", "-1");
    list.set(controls::AnalogueGain, static_cast<float>(config.gain));
  }
  if (config.focus >= 0.0) {
    if (!has(known, controls::LensPosition)) return missing("camera.focus", "focus", "-1");
    list.set(controls::LensPosition, static_cast<float>(config.focus));
  }
  return OpenResult::Opened;
}

OpenResult LibcameraSession::start(const CameraConfig& config) {
  libcamera::ControlList list(camera_->controls());
  if (const OpenResult set = set_controls(config, list); set != OpenResult::Opened) return set;
  camera_->requestCompleted.connect(this, &LibcameraSession::on_completed);
  camera_->disconnected.connect(this, &LibcameraSession::on_disconnected);
  if (const int error = camera_->start(&list); error != 0) {
    return fail(OpenResult::Absent, fmt::format("does not start: {}", std::strerror(-error)));
  }
  started_ = true;
  stall.opened(monotonic_now_ns());
  for (const auto& request : requests_) {
    if (camera_->queueRequest(request.get()) != 0) return fail(OpenResult::Absent, "takes no requests");
  }
  return OpenResult::Opened;
}

}  // namespace heel
