#include "sim/live/live_camera.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "heel/error.h"
#include "realtime/clock.h"
#include "sim/live/picture_file.h"

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
  const double dt_s = seconds_from_ns(t_ns - truth.t_ns);
  const double mid_heading_rad = truth.pose.heading_rad + 0.5 * dt_s * truth.yaw_rate_rad_s;
  RobotMotion motion;
  motion.x_m = truth.pose.x_m + dt_s * truth.v_m_s * std::cos(mid_heading_rad);
  motion.y_m = truth.pose.y_m + dt_s * truth.v_m_s * std::sin(mid_heading_rad);
  motion.heading_rad = truth.pose.heading_rad + dt_s * truth.yaw_rate_rad_s;
  motion.v_m_s = truth.v_m_s;
  motion.yaw_rate_rad_s = truth.yaw_rate_rad_s;
  return motion;
}

LiveCamera::LiveCamera(World& world, const SharedMotion& motion, std::unique_ptr<FrameSink> sink,
                       TimeNs t_start_ns, const std::string& saved_folder, double saved_every_s)
    : world_(world),
      motion_(motion),
      sink_(std::move(sink)),
      t_start_ns_(t_start_ns),
      saved_folder_(saved_folder),
      saved_every_ns_(ns_from_seconds(saved_every_s)),
      t_save_ns_(saved_every_ns_ / 2) {
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

LiveCameraCounters LiveCamera::counters() const {
  const std::scoped_lock lock(counters_mutex_);
  return counters_;
}

void LiveCamera::run() {
  const TimeNs period_ns = ns_from_seconds(1.0 / world_.scenario().camera.rate_hz);
  std::uint64_t sequence = 1 + static_cast<std::uint64_t>((monotonic_now_ns() - t_start_ns_) / period_ns);
  while (!stop_) {
    const TimeNs t_ns = static_cast<TimeNs>(sequence) * period_ns;
    sleep_until_ns(t_start_ns_ + readable_ns(t_ns));
    try {
      draw(sequence, t_ns);
    } catch (const Error& error) {
      std::fprintf(stderr, "heel-sim: %s; no more frames\n", error.what());
      return;
    }
    // Frames whose time has passed meanwhile are left out; the count goes on, as a camera's does.
    const auto due = static_cast<std::uint64_t>((monotonic_now_ns() - t_start_ns_) / period_ns);
    const std::uint64_t next = std::max(sequence + 1, due);
    if (next > sequence + 1) {
      const std::scoped_lock lock(counters_mutex_);
      counters_.frames_late += next - sequence - 1;
    }
    sequence = next;
  }
}

/// A frame is there when its last row's exposure has ended.
TimeNs LiveCamera::readable_ns(TimeNs t_ns) const {
  return t_ns + ns_from_seconds(0.5e-3 * (world_.exposure(seconds_from_ns(t_ns)).exposure_ms +
                                          world_.scenario().camera.readout_ms));
}

void LiveCamera::draw(std::uint64_t sequence, TimeNs t_ns) {
  const TimeNs t_begin_ns = monotonic_now_ns();
  const FrameFate fate = frame_fate(world_.scenario().camera.timing, world_.scenario().seed, sequence);
  if (fate.dropped) {
    const std::scoped_lock lock(counters_mutex_);
    ++counters_.frames_dropped;
    return;
  }
  world_.render(motion_.at(t_ns), seconds_from_ns(t_ns), sequence, grey_);
  const double took_ms = 1e-6 * static_cast<double>(monotonic_now_ns() - t_begin_ns);
  if (fate.delay_ns > 0) sleep_until_ns(t_start_ns_ + readable_ns(t_ns) + fate.delay_ns);
  const CameraModel& camera = world_.scenario().camera.model;
  FrameHeader header;
  header.sequence = sequence;
  header.t_capture_ns = t_start_ns_ + t_ns + fate.stamp_error_ns;
  header.width_px = static_cast<std::uint32_t>(camera.width_px);
  header.height_px = static_cast<std::uint32_t>(camera.height_px);
  sink_->put(header, grey_);
  {
    const std::scoped_lock lock(counters_mutex_);
    ++counters_.frames;
    counters_.draw_ms_mean += (took_ms - counters_.draw_ms_mean) / static_cast<double>(counters_.frames);
    counters_.draw_ms_worst = std::max(counters_.draw_ms_worst, took_ms);
  }
  if (!saved_folder_.empty() && t_ns >= t_save_ns_) save(sequence, t_ns);
}

void LiveCamera::save(std::uint64_t sequence, TimeNs t_ns) {
  const CameraModel& camera = world_.scenario().camera.model;
  while (t_save_ns_ <= t_ns) t_save_ns_ += saved_every_ns_;
  char name[32];
  std::snprintf(name, sizeof name, "/%06llu.png", static_cast<unsigned long long>(sequence));
  try {
    write_grey_picture(saved_folder_ + name, grey_, camera.width_px, camera.height_px);
  } catch (const Error& error) {
    std::fprintf(stderr, "heel-sim: %s; no more frames are kept\n", error.what());
    saved_folder_.clear();
  }
}

}  // namespace heel::sim
