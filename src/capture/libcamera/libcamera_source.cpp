#include "capture/libcamera/libcamera_source.h"

#include <libcamera/libcamera.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <vector>

#include "capture/driver_count.h"
#include "capture/jpeg_decoder.h"
#include "capture/pixel_format.h"
#include "heel/error.h"
#include "realtime/clock.h"
#include "realtime/futex.h"
#include "realtime/spsc_queue.h"

namespace heel {

namespace {

constexpr unsigned kWantedBuffers = 4;

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

/// The first plane of a buffer (the luma), mapped.
struct Mapping {
  const libcamera::FrameBuffer* buffer = nullptr;
  void* memory = MAP_FAILED;
  std::size_t mapped_bytes = 0;
  std::size_t offset = 0;
  std::size_t bytes = 0;

  const std::uint8_t* data() const { return static_cast<const std::uint8_t*>(memory) + offset; }
};

}  // namespace

/// Everything that lives from open() to close().
struct LibcameraSource::Session {
  ~Session();
  void on_completed(libcamera::Request* request);  // in libcamera's thread
  void on_disconnected();                          // in libcamera's thread
  const Mapping* mapping_of(const libcamera::FrameBuffer* buffer) const;

  libcamera::CameraManager manager;
  bool manager_started = false;
  std::shared_ptr<libcamera::Camera> camera;
  bool acquired = false;
  bool started = false;
  std::unique_ptr<libcamera::CameraConfiguration> configuration;
  std::unique_ptr<libcamera::FrameBufferAllocator> allocator;
  std::vector<std::unique_ptr<libcamera::Request>> requests;
  std::vector<Mapping> mappings;
  PixelFormat format = PixelFormat::Grey;

  SpscQueue<libcamera::Request*> completed{2 * kWantedBuffers};
  std::atomic<std::uint32_t> signal{0};
  std::atomic<bool> disconnected{false};

  libcamera::Request* held = nullptr;  // ours until the next wait_frame
  TimeNs heard_ns = 0;
  DriverCount count;
  JpegDecoder jpeg;
  std::vector<std::uint8_t> grey;
};

LibcameraSource::Session::~Session() {
  if (started) camera->stop();
  if (camera) {
    camera->requestCompleted.disconnect(this);
    camera->disconnected.disconnect(this);
  }
  for (const Mapping& mapping : mappings) munmap(mapping.memory, mapping.mapped_bytes);
  requests.clear();
  allocator.reset();
  if (acquired) camera->release();
  camera.reset();
  if (manager_started) manager.stop();
}

void LibcameraSource::Session::on_completed(libcamera::Request* request) {
  completed.push(request);
  signal.fetch_add(1, std::memory_order_release);
  futex_wake_all(signal, FutexScope::Process);
}

void LibcameraSource::Session::on_disconnected() {
  disconnected.store(true, std::memory_order_release);
  signal.fetch_add(1, std::memory_order_release);
  futex_wake_all(signal, FutexScope::Process);
}

const Mapping* LibcameraSource::Session::mapping_of(const libcamera::FrameBuffer* buffer) const {
  for (const Mapping& mapping : mappings) {
    if (mapping.buffer == buffer) return &mapping;
  }
  return nullptr;
}

LibcameraSource::LibcameraSource(const std::string& id, const CameraConfig& config)
    : FrameSource("libcamera:" + id), id_(id), config_(config) {}

LibcameraSource::~LibcameraSource() = default;

OpenResult LibcameraSource::open() {
  close();
  session_ = std::make_unique<Session>();
  OpenResult result = find_camera();
  if (result == OpenResult::Opened) result = configure();
  if (result == OpenResult::Opened) result = start();
  if (result != OpenResult::Opened) close();
  return result;
}

OpenResult LibcameraSource::find_camera() {
  Session& s = *session_;
  if (const int error = s.manager.start(); error != 0) {
    return fail(OpenResult::Refused, std::string("libcamera does not start: ") + std::strerror(-error));
  }
  s.manager_started = true;
  s.camera = s.manager.get(id_);
  if (!s.camera) {
    std::string known;
    for (const auto& camera : s.manager.cameras()) known += (known.empty() ? "" : ", ") + camera->id();
    return fail(OpenResult::Absent,
                "libcamera knows no camera of this id; it knows " + (known.empty() ? "none" : known));
  }
  if (const int error = s.camera->acquire(); error != 0) {
    return fail(OpenResult::Absent, std::string("cannot be acquired: ") + std::strerror(-error));
  }
  s.acquired = true;
  return OpenResult::Opened;
}

OpenResult LibcameraSource::configure() {
  Session& s = *session_;
  s.configuration = s.camera->generateConfiguration({libcamera::StreamRole::Viewfinder});
  if (!s.configuration || s.configuration->empty()) return fail(OpenResult::Refused, "offers no stream");
  libcamera::StreamConfiguration& stream = s.configuration->at(0);
  const libcamera::Size size(static_cast<unsigned>(config_.width_px),
                             static_cast<unsigned>(config_.height_px));

  PixelFormat only = PixelFormat::Grey;
  const bool named = parse_pixel_format(config_.format, only);
  bool agreed = false;
  for (const PixelFormat candidate : pixel_formats()) {
    if (agreed || (named && candidate != only)) continue;
    stream.pixelFormat = library_format(candidate);
    stream.size = size;
    stream.bufferCount = kWantedBuffers;
    agreed = s.configuration->validate() != libcamera::CameraConfiguration::Invalid &&
             stream.pixelFormat == library_format(candidate) && stream.size == size;
    s.format = candidate;
  }
  if (!agreed) {
    return fail(OpenResult::Refused, "does not give " + size.toString() + " as " + config_.format +
                                         " (nearest: " + stream.toString() +
                                         "); expected a size and format it has");
  }
  if (const int error = s.camera->configure(s.configuration.get()); error != 0) {
    return fail(OpenResult::Refused, std::string("cannot be configured: ") + std::strerror(-error));
  }
  description_ = address_ + ": " + stream.toString();
  s.grey.assign(std::size_t{size.width} * size.height, 0);

  s.allocator = std::make_unique<libcamera::FrameBufferAllocator>(s.camera);
  if (s.allocator->allocate(stream.stream()) < 0) return fail(OpenResult::Refused, "gives no buffers");
  for (const auto& buffer : s.allocator->buffers(stream.stream())) {
    const libcamera::FrameBuffer::Plane& plane = buffer->planes().front();
    Mapping mapping{.buffer = buffer.get(), .offset = plane.offset, .bytes = plane.length};
    mapping.mapped_bytes = mapping.offset + mapping.bytes;
    mapping.memory = mmap(nullptr, mapping.mapped_bytes, PROT_READ, MAP_SHARED, plane.fd.get(), 0);
    if (mapping.memory == MAP_FAILED) return fail(OpenResult::Refused, "its buffers cannot be mapped");
    s.mappings.push_back(mapping);
    std::unique_ptr<libcamera::Request> request = s.camera->createRequest();
    if (!request || request->addBuffer(stream.stream(), buffer.get()) != 0) {
      return fail(OpenResult::Refused, "takes no requests");
    }
    s.requests.push_back(std::move(request));
  }
  return OpenResult::Opened;
}

OpenResult LibcameraSource::start() {
  namespace controls = libcamera::controls;
  Session& s = *session_;
  const libcamera::ControlInfoMap& has = s.camera->controls();
  libcamera::ControlList asked(has);
  if (has.count(controls::FrameDurationLimits.id()) != 0 && config_.rate_hz > 0.0) {
    const auto period_us = static_cast<std::int64_t>(1e6 / config_.rate_hz);
    const std::array<std::int64_t, 2> limits{period_us, period_us};
    asked.set(controls::FrameDurationLimits, libcamera::Span<const std::int64_t, 2>(limits));
  }
  if (config_.exposure_ms > 0.0) {
    if (has.count(controls::ExposureTime.id()) == 0) {
      return fail(OpenResult::Refused,
                  "camera.exposure_ms: the camera has no control of its exposure; expected 0");
    }
    if (has.count(controls::AeEnable.id()) != 0) asked.set(controls::AeEnable, false);
    asked.set(controls::ExposureTime, static_cast<std::int32_t>(config_.exposure_ms * 1e3));
  }
  if (config_.gain >= 0.0) {
    if (has.count(controls::AnalogueGain.id()) == 0) {
      return fail(OpenResult::Refused, "camera.gain: the camera has no control of its gain; expected -1");
    }
    asked.set(controls::AnalogueGain, static_cast<float>(config_.gain));
  }
  if (config_.focus >= 0.0) {
    if (has.count(controls::LensPosition.id()) == 0) {
      return fail(OpenResult::Refused, "camera.focus: the camera has no control of its focus; expected -1");
    }
    asked.set(controls::LensPosition, static_cast<float>(config_.focus));
  }
  s.camera->requestCompleted.connect(&s, &Session::on_completed);
  s.camera->disconnected.connect(&s, &Session::on_disconnected);
  if (const int error = s.camera->start(&asked); error != 0) {
    return fail(OpenResult::Absent, std::string("does not start: ") + std::strerror(-error));
  }
  s.started = true;
  s.heard_ns = monotonic_now_ns();
  for (const auto& request : s.requests) {
    if (s.camera->queueRequest(request.get()) != 0) return fail(OpenResult::Absent, "takes no requests");
  }
  return OpenResult::Opened;
}

FrameResult LibcameraSource::wait_frame(TimeNs timeout_ns, FrameView& frame) {
  if (!session_) return fail(FrameResult::Lost, "not open");
  Session& s = *session_;
  if (s.held != nullptr) {
    s.held->reuse(libcamera::Request::ReuseBuffers);
    if (s.camera->queueRequest(s.held) != 0) give_up("takes no request back");
    s.held = nullptr;
  }
  const std::uint32_t seen = s.signal.load(std::memory_order_acquire);
  if (!s.completed.pop(s.held)) {
    futex_wait(s.signal, seen, timeout_ns, FutexScope::Process);
    if (!s.completed.pop(s.held)) s.held = nullptr;
  }
  if (s.disconnected.load(std::memory_order_acquire)) give_up("the camera has gone");
  const TimeNs now_ns = monotonic_now_ns();
  if (s.held == nullptr) {
    if (now_ns - s.heard_ns > kStall_ns) give_up("no frame for 2 s");
    return FrameResult::Timeout;
  }
  s.heard_ns = now_ns;
  if (s.held->status() == libcamera::Request::RequestCancelled) {
    give_up("a request was cancelled");
  }
  return deliver(now_ns, frame);
}

/// libcamera 0.0.3 aborts the program when a camera that has gone is stopped (an assertion in
/// PipelineHandler::stop), and does not always tell that it has gone. So the session of a camera that fails
/// is left as it is, and the program must end in order and be started again, as systemd does.
void LibcameraSource::give_up(const char* what) {
  static auto* const left_alone = new std::vector<std::unique_ptr<Session>>;  // not even at the program's end
  left_alone->push_back(std::move(session_));
  throw Error(address_ + ": " + what + "; libcamera opens a camera that failed only in a new process");
}

FrameResult LibcameraSource::deliver(TimeNs arrived_ns, FrameView& frame) {
  Session& s = *session_;
  const libcamera::FrameBuffer* buffer = s.held->buffers().begin()->second;
  const libcamera::FrameMetadata& metadata = buffer->metadata();
  s.count.advance(metadata.sequence);
  counters_.dropped_by_driver += s.count.gap();
  if (metadata.status != libcamera::FrameMetadata::FrameSuccess) {
    ++counters_.dropped_by_driver;
    return fail(FrameResult::Error, "a frame the driver marked as damaged");
  }
  const auto stamp_ns = static_cast<TimeNs>(metadata.timestamp);
  const auto width_px = static_cast<std::uint32_t>(config_.width_px);
  const auto height_px = static_cast<std::uint32_t>(config_.height_px);
  frame.header = {.sequence = s.count.sequence(),
                  .t_capture_ns = is_believable_stamp(stamp_ns, arrived_ns) ? stamp_ns : arrived_ns,
                  .width_px = width_px,
                  .height_px = height_px};

  const Mapping* mapping = s.mapping_of(buffer);
  const std::uint32_t stride = s.configuration->at(0).stride;
  const std::size_t used = metadata.planes().empty() ? 0 : metadata.planes()[0].bytesused;
  if (mapping == nullptr || used == 0 || used > mapping->bytes ||
      used < luma_bytes_needed(s.format, width_px, height_px, stride)) {
    ++counters_.corrupt;
    return fail(FrameResult::Error, "a frame that is too short");
  }
  Luma luma{s.grey.data(), width_px};
  if (s.format != PixelFormat::Mjpg) {
    luma = luma_of(s.format, mapping->data(), stride, width_px, height_px, s.grey.data());
  } else if (!s.jpeg.decode(mapping->data(), used, width_px, height_px, s.grey.data())) {
    ++counters_.corrupt;
    return fail(FrameResult::Error, s.jpeg.problem());
  }
  frame.grey = luma.first;
  frame.stride_bytes = luma.stride_bytes;
  return FrameResult::Frame;
}

void LibcameraSource::close() {
  session_.reset();
}

}  // namespace heel
