#include "sim/live/live_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "files/image_file.h"
#include "heel/error.h"
#include "realtime/clock.h"
#include "sim/contact/robot_in_world.h"

namespace heel::sim {

void SharedMotion::set(const RobotTruth& truth) {
  const std::scoped_lock lock(mutex_);
  truth_ = truth;
}

RobotMotion SharedMotion::at(TimeNs t_ns) const {
  RobotTruth truth;
  {
    const std::scoped_lock lock(mutex_);
    truth = truth_;
  }
  return moved(robot_motion_from_truth(truth), seconds_from_ns(t_ns - truth.t_ns));
}

LiveCamera::LiveCamera(World& world, const SharedMotion& motion, OpenSink open_sink, TimeNs t_start_ns,
                       const std::string& saved_folder, double saved_every_s)
    : world_(world),
      motion_(motion),
      turner_(world.scenario().camera.turn.inverse()),
      open_sink_(std::move(open_sink)),
      sink_(open_sink_()),
      t_start_ns_(t_start_ns),
      period_ns_(ns_from_seconds(1.0 / world.scenario().camera.rate_hz)),
      saved_folder_(saved_folder),
      saved_every_ns_(ns_from_seconds(saved_every_s)),
      t_next_save_ns_(saved_every_ns_ / 2) {
  if (!saved_folder_.empty()) {
    std::error_code error;
    std::filesystem::create_directories(saved_folder_, error);
    if (error) throw Error("--frames " + saved_folder_ + ": cannot make the folder: " + error.message());
  }
  thread_ = std::thread([this] { run(); });
}

LiveCamera::~LiveCamera() {
  stop_ = true;
  thread_.join();
}

void LiveCamera::take_away(TimeNs duration_ns) {
  t_back_ns_ = monotonic_now_ns() + duration_ns;
}

LiveCameraCounters LiveCamera::counters() const {
  const std::scoped_lock lock(counters_mutex_);
  return counters_;
}

/// The frame whose time is now.
std::uint64_t LiveCamera::current_sequence() const {
  return static_cast<std::uint64_t>((monotonic_now_ns() - t_start_ns_) / period_ns_);
}

/// Renders and publishes a frame at each frame time until stop_.
void LiveCamera::run() {
  std::uint64_t sequence = 1 + current_sequence();
  while (!stop_) {
    const TimeNs t_ns = static_cast<TimeNs>(sequence) * period_ns_;
    sleep_until_ns(t_start_ns_ + readable_ns(t_ns));
    try {
      if (monotonic_now_ns() < t_back_ns_) {
        sink_.reset();
      } else {
        if (!sink_) sink_ = open_sink_();
        draw(sequence, t_ns);
      }
    } catch (const Error& error) {
      fmt::print(stderr, "heel-sim: {}; the camera sends no more frames\n", error.what());
      return;
    }
    // Frames whose time has passed while this one was drawn are left out. Their numbers are left out too, as
    // a camera's are.
    const std::uint64_t next = std::max(sequence + 1, current_sequence());
    if (next > sequence + 1) {
      const std::scoped_lock lock(counters_mutex_);
      counters_.frames_late += next - sequence - 1;
    }
    sequence = next;
  }
}

/// When the exposure of the last row has ended.
TimeNs LiveCamera::readable_ns(TimeNs t_ns) const {
  return t_ns + ns_from_seconds(0.5e-3 * (world_.exposure(seconds_from_ns(t_ns)).exposure_ms +
                                          world_.scenario().camera.readout_ms));
}

void LiveCamera::draw(std::uint64_t sequence, TimeNs t_ns) {
  const TimeNs t_begin_ns = monotonic_now_ns();
  const FrameDelivery delivery =
      frame_delivery(world_.scenario().camera.timing, world_.scenario().seed, sequence);
  if (delivery.dropped) {
    const std::scoped_lock lock(counters_mutex_);
    ++counters_.frames_dropped;
    return;
  }
  world_.render(motion_.at(t_ns), seconds_from_ns(t_ns), sequence, grey_);
  const double draw_ms = 1e-6 * static_cast<double>(monotonic_now_ns() - t_begin_ns);
  if (delivery.delay_ns > 0) sleep_until_ns(t_start_ns_ + readable_ns(t_ns) + delivery.delay_ns);
  const CameraModel& camera = world_.scenario().camera.model;
  FrameHeader header;
  header.sequence = sequence;
  header.t_capture_ns = t_start_ns_ + t_ns + delivery.stamp_error_ns;
  header.width_px = static_cast<std::uint32_t>(camera.width_px);
  header.height_px = static_cast<std::uint32_t>(camera.height_px);
  sink_->put(turner_.of({header, grey_.data(), header.width_px}));
  {
    const std::scoped_lock lock(counters_mutex_);
    ++counters_.frames;
    counters_.draw_ms_mean += (draw_ms - counters_.draw_ms_mean) / static_cast<double>(counters_.frames);
    counters_.draw_ms_max = std::max(counters_.draw_ms_max, draw_ms);
  }
  if (!saved_folder_.empty() && t_ns >= t_next_save_ns_) save(sequence, t_ns);
}

void LiveCamera::save(std::uint64_t sequence, TimeNs t_ns) {
  const CameraModel& camera = world_.scenario().camera.model;
  while (t_next_save_ns_ <= t_ns) t_next_save_ns_ += saved_every_ns_;
  try {
    write_grey_image(fmt::format("{}/{:06}.png", saved_folder_, sequence), grey_.data(), camera.width_px,
                     camera.height_px);
  } catch (const Error& error) {
    fmt::print(stderr, "heel-sim: {}; no more frames are saved\n", error.what());
    saved_folder_.clear();
  }
}

}  // namespace heel::sim
