// A V4L2 device made of tables: what it offers, which frames it gives, and which call fails with which error.
// It keeps the kernel's rules (it fills only queued buffers, a buffer is dequeued once, and so on) and fails
// the test when the source breaks them.
#pragma once

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "capture/v4l2/v4l2_device.h"
#include "realtime/clock.h"

namespace heel::test {

struct ScriptedControl {
  std::int32_t least = 0;
  std::int32_t most = 100;
  std::int32_t step = 1;
  std::int32_t value = 0;
  bool stuck = false;  ///< takes any value and keeps its own
};

/// One frame the device will give.
struct ScriptedFrame {
  std::vector<std::uint8_t> bytes{};
  std::uint32_t sequence = 0;
  std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  TimeNs t_ns = 0;  ///< 0: now
  int error = 0;    ///< of DQBUF, instead of a frame
};

/// The camera's state. It outlives the device, which the source owns, so that tests can read and change it.
struct ScriptedCamera {
  std::string card = "Scripted camera";
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<std::uint32_t> formats{V4L2_PIX_FMT_YUYV};
  std::map<std::uint32_t, double> fastest_hz;  ///< by format; others reach any rate
  std::uint32_t width = 8, height = 4;         ///< the only size it has
  std::uint32_t padding = 0;                   ///< bytes after each row
  std::uint32_t field = V4L2_FIELD_NONE;
  bool rate_settable = true;
  std::map<std::uint32_t, ScriptedControl> controls;
  std::uint32_t most_buffers = 8;
  int open_error = 0;
  TimeNs first_frame_after_ns = 0;              ///< after STREAMON
  std::set<std::uint32_t> without_bandwidth{};  ///< formats for which STREAMON answers ENOSPC
  std::map<unsigned long, int> errors;          ///< by request: errno, for as long as it stands here
  std::deque<ScriptedFrame> frames;

  // The calls that it received.
  std::string opened_path;
  int opened = 0, closed = 0, mapped = 0, unmapped = 0;
  std::uint32_t format = 0;
  double rate_hz = 5.0;
  bool streaming = false;
  std::set<std::uint32_t> queued;
};

class ScriptedV4l2Device final : public V4l2Device {
 public:
  explicit ScriptedV4l2Device(ScriptedCamera& camera) : camera_(camera) {}

  int open(const std::string& path) override {
    camera_.opened_path = path;
    if (camera_.open_error == 0) ++camera_.opened;
    return camera_.open_error;
  }
  void close() override {
    ++camera_.closed;
    camera_.queued.clear();
    camera_.streaming = false;
    memory_.clear();
  }
  void* map(std::size_t bytes, std::int64_t offset) override {
    ++camera_.mapped;
    auto& memory = memory_.at(static_cast<std::size_t>(offset));
    EXPECT_EQ(memory.size(), bytes);
    return memory.data();
  }
  void unmap(void*, std::size_t) override { ++camera_.unmapped; }
  PollResult wait_readable(TimeNs timeout_ns) override {
    EXPECT_TRUE(camera_.streaming);
    const bool started = monotonic_now_ns() - t_streamon_ns_ >= camera_.first_frame_after_ns;
    if (started && !camera_.frames.empty()) return PollResult::Ready;
    sleep_until_ns(monotonic_now_ns() + std::min(timeout_ns, kNsPerMs));
    return PollResult::Timeout;
  }

  int control(unsigned long request, void* argument) override {
    if (const auto error = camera_.errors.find(request); error != camera_.errors.end()) return error->second;
    switch (request) {
      case VIDIOC_QUERYCAP:
        return query(*static_cast<v4l2_capability*>(argument));
      case VIDIOC_ENUM_FMT:
        return enumerate(*static_cast<v4l2_fmtdesc*>(argument));
      case VIDIOC_S_FMT:
        return set_format(*static_cast<v4l2_format*>(argument));
      case VIDIOC_G_PARM:
        return get_rate(*static_cast<v4l2_streamparm*>(argument));
      case VIDIOC_S_PARM:
        return set_rate(*static_cast<v4l2_streamparm*>(argument));
      case VIDIOC_QUERYCTRL:
        return query_control(*static_cast<v4l2_queryctrl*>(argument));
      case VIDIOC_G_CTRL:
        return get_control(*static_cast<v4l2_control*>(argument));
      case VIDIOC_S_CTRL:
        return set_control(*static_cast<v4l2_control*>(argument));
      case VIDIOC_REQBUFS:
        return request_buffers(*static_cast<v4l2_requestbuffers*>(argument));
      case VIDIOC_QUERYBUF:
        return query_buffer(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_QBUF:
        return queue(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_DQBUF:
        return dequeue(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_STREAMON:
        if (camera_.without_bandwidth.contains(camera_.format)) return ENOSPC;
        camera_.streaming = true;
        t_streamon_ns_ = monotonic_now_ns();
        return 0;
      case VIDIOC_STREAMOFF:
        camera_.streaming = false;
        return 0;
      default:
        ADD_FAILURE() << "an unexpected request: " << request;
        return ENOTTY;
    }
  }

 private:
  int query(v4l2_capability& capability) const {
    std::strncpy(reinterpret_cast<char*>(capability.card), camera_.card.c_str(), sizeof(capability.card) - 1);
    // The driver as a whole has every capability; this node's capabilities count.
    capability.capabilities = camera_.capabilities | V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_CAPTURE |
                              V4L2_CAP_STREAMING | V4L2_CAP_VIDEO_OUTPUT;
    capability.device_caps = camera_.capabilities;
    return 0;
  }
  int enumerate(v4l2_fmtdesc& description) const {
    if (description.index >= camera_.formats.size()) return EINVAL;
    description.pixelformat = camera_.formats[description.index];
    return 0;
  }
  int set_format(v4l2_format& format) {
    v4l2_pix_format& pix = format.fmt.pix;
    const auto& offered = camera_.formats;
    // As drivers do, it replaces a format or size that it does not have.
    if (std::find(offered.begin(), offered.end(), pix.pixelformat) == offered.end()) {
      pix.pixelformat = offered.front();
    }
    pix.width = camera_.width;
    pix.height = camera_.height;
    pix.field = camera_.field;
    const std::uint32_t pixel_bytes = pix.pixelformat == V4L2_PIX_FMT_YUYV    ? 2
                                      : pix.pixelformat == V4L2_PIX_FMT_RGB24 ? 3
                                      : pix.pixelformat == V4L2_PIX_FMT_BGR24 ? 3
                                                                              : 1;
    pix.bytesperline = pix.pixelformat == V4L2_PIX_FMT_MJPEG ? 0 : pix.width * pixel_bytes + camera_.padding;
    pix.sizeimage = 2 * (pix.width * 3 + camera_.padding) * pix.height + 4096;
    image_bytes_ = pix.sizeimage;
    camera_.format = pix.pixelformat;
    camera_.rate_hz = 5.0;  // setting the format resets the rate
    return 0;
  }
  int get_rate(v4l2_streamparm& parameters) const {
    parameters.parm.capture.capability = camera_.rate_settable ? V4L2_CAP_TIMEPERFRAME : 0;
    parameters.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(camera_.rate_hz * 1000.0)};
    return 0;
  }
  int set_rate(v4l2_streamparm& parameters) {
    const v4l2_fract& interval = parameters.parm.capture.timeperframe;
    camera_.rate_hz = static_cast<double>(interval.denominator) / interval.numerator;
    if (const auto fastest = camera_.fastest_hz.find(camera_.format); fastest != camera_.fastest_hz.end()) {
      camera_.rate_hz = std::min(camera_.rate_hz, fastest->second);
    }
    return 0;
  }
  int query_control(v4l2_queryctrl& query) const {
    const auto control = camera_.controls.find(query.id);
    if (control == camera_.controls.end()) return EINVAL;
    query.minimum = control->second.least;
    query.maximum = control->second.most;
    query.step = control->second.step;
    return 0;
  }
  int get_control(v4l2_control& control) const {
    control.value = camera_.controls.at(control.id).value;
    return 0;
  }
  int set_control(v4l2_control& control) {
    ScriptedControl& own = camera_.controls.at(control.id);
    if (control.value < own.least || control.value > own.most) return ERANGE;
    if (!own.stuck) own.value = control.value;
    return 0;
  }
  int request_buffers(v4l2_requestbuffers& request) {
    request.count = std::min(request.count, camera_.most_buffers);
    memory_.assign(request.count, std::vector<std::uint8_t>(image_bytes_));
    return 0;
  }
  int query_buffer(v4l2_buffer& buffer) const {
    buffer.length = static_cast<std::uint32_t>(memory_.at(buffer.index).size());
    buffer.m.offset = buffer.index;
    return 0;
  }
  int queue(const v4l2_buffer& buffer) {
    EXPECT_LT(buffer.index, memory_.size());
    EXPECT_TRUE(camera_.queued.insert(buffer.index).second) << "queued twice";
    // Code that reads a buffer after it was queued again sees this.
    std::fill(memory_[buffer.index].begin(), memory_[buffer.index].end(), std::uint8_t{0xdb});
    return 0;
  }
  int dequeue(v4l2_buffer& buffer) {
    if (camera_.frames.empty()) return EAGAIN;
    if (camera_.queued.empty()) {
      ADD_FAILURE() << "no buffer is queued: the camera would stall";
      return EAGAIN;
    }
    const ScriptedFrame frame = std::move(camera_.frames.front());
    camera_.frames.pop_front();
    if (frame.error != 0) return frame.error;
    buffer.index = *camera_.queued.begin();
    camera_.queued.erase(camera_.queued.begin());
    std::copy(frame.bytes.begin(), frame.bytes.end(), memory_[buffer.index].begin());
    buffer.bytesused = static_cast<std::uint32_t>(frame.bytes.size());
    buffer.sequence = frame.sequence;
    buffer.flags = frame.flags;
    const TimeNs t_ns = frame.t_ns != 0 ? frame.t_ns : monotonic_now_ns();
    buffer.timestamp = {t_ns / kNsPerS, t_ns % kNsPerS / kNsPerUs};
    return 0;
  }

  ScriptedCamera& camera_;
  std::size_t image_bytes_ = 0;
  TimeNs t_streamon_ns_ = 0;
  std::vector<std::vector<std::uint8_t>> memory_;
};

}  // namespace heel::test
