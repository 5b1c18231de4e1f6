// A run whose figures were calculated by hand. Truth and ticks every 0.1 s for 10 s, frames halfway between:
//   person  stands at x = 0 until 2 s, then walks along x at 0.5 m/s                    → 4 m in 8 s
//   robot   2 m behind, 0.3 m to the left until 6 s and 0.1 m to the right from then on
//   back    turns by 0.2 rad/s in the camera; yaw is measured 0.1 rad too large in even frames and 0.06 rad
//   too
//           small in odd ones, the distance 0.05 m too large
//   frames  50 … 54 do not show the target: none from 4.95 s to 5.55 s
//   ticks   30 … 34 are at rest because the target is lost; from tick 95 on the daemon shuts down
#pragma once

#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "files/template_file.h"
#include "heel/shirt_template.h"
#include "support/temporary_folder.h"
#include "telemetry/recorder.h"

namespace heel::test {

inline constexpr double kEvenYawError_rad = 0.1, kOddYawError_rad = -0.06, kYawSigma_rad = 0.1;
inline constexpr double kZError_m = 0.05;
inline constexpr double kClock_s = 1000.0;  ///< the monotonic clock at the run's beginning

template <typename... Values>
std::string printed(const char* format, Values... values) {
  char text[300];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

inline std::string truth_csv() {
  std::string text =
      "t_s,t_monotonic_s,robot_x_m,robot_y_m,robot_heading_rad,person_x_m,person_y_m,person_heading_rad,"
      "person_speed_m_s,target_x_m,target_y_m,target_z_m,target_yaw_rad,target_in_view\n";
  for (int i = 0; i <= 100; ++i) {
    const double person_x_m = i < 20 ? 0.0 : 0.05 * (i - 20);
    text += printed("%.1f,%.1f,%.2f,%.1f,0,%.2f,0,0,%.1f,0,-0.1,2.0,%.2f,1\n", 0.1 * i, kClock_s + 0.1 * i,
                    person_x_m - 2.0, i < 60 ? 0.3 : -0.1, person_x_m, i < 20 ? 0.0 : 0.5, 0.02 * i);
  }
  return text;
}

inline void record_ticks(Recorder& recorder) {
  for (int i = 0; i <= 100; ++i) {
    TickRecord tick;
    tick.tick = static_cast<std::uint64_t>(i);
    tick.input.now_ns = ns_from_seconds(kClock_s + 0.1 * i);
    tick.stop_reason = i >= 95             ? StopReason::Shutdown
                       : i >= 30 && i < 35 ? StopReason::TargetLost
                                           : StopReason::None;
    tick.command.v_m_s = tick.stop_reason == StopReason::None ? 0.5 : 0.0;
    tick.command.yaw_rate_rad_s = -0.2;
    recorder.record(tick);
  }
}

inline void record_poses(Recorder& recorder) {
  for (int k = 0; k < 100; ++k) {
    PoseEstimate pose;
    pose.frame_sequence = static_cast<std::uint64_t>(k);
    pose.t_capture_ns = pose.t_done_ns = ns_from_seconds(kClock_s + 0.1 * k + 0.05);
    if (k >= 50 && k < 55) {
      pose.reason = PoseReason::TooFewInliers;
      pose.certainty = 0.02;
    } else {
      pose.reason = PoseReason::Found;
      pose.certainty = 0.3;
      pose.yaw_rad = 0.02 * (k + 0.5) + (k % 2 == 0 ? kEvenYawError_rad : kOddYawError_rad);
      pose.frame_yaw_rad = pose.yaw_rad;
      pose.frame_yaw_sigma_rad = kYawSigma_rad;
      pose.has_distance = true;
      pose.position_m = {0.0, -0.1, 2.0 + kZError_m};
      pose.H_cur_from_ref = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    }
    recorder.record(pose);
  }
}

inline constexpr const char* kRunRecording = "run.mcap";

/// The run's recording; without poses: vision saw no frame.
inline void record_run(const TemporaryFolder& folder, bool with_poses) {
  std::filesystem::remove(folder.file(kRunRecording));
  Recorder recorder(folder.file(kRunRecording), RecordingClock{});
  record_ticks(recorder);
  if (with_poses) record_poses(recorder);
}

inline void write_run(const TemporaryFolder& folder) {
  write_text(folder.file("truth.csv"), truth_csv());
  record_run(folder, /*with_poses=*/true);
}

/// Kept frames of these numbers, each a little brighter than the one before, and a template whose region is
/// known. Every homography of the run is the identity.
inline void keep_frames(const TemporaryFolder& folder, const std::vector<int>& numbers) {
  ShirtTemplate shirt;
  shirt.camera = {.width_px = 320, .height_px = 240, .fx = 300, .fy = 300, .cx = 160, .cy = 120};
  shirt.grey.assign(320 * 240, 128);
  shirt.roi = {.x_px = 100, .y_px = 60, .width_px = 120, .height_px = 90};
  shirt.distance_m = 1.5;
  write_template(shirt, folder.file("shirt.heel"));
  std::filesystem::create_directory(folder.file("frames"));
  double grey = 10.0;
  for (const int number : numbers) {
    cv::imwrite(folder.file("frames/" + printed("%06d.png", number)),
                cv::Mat(240, 320, CV_8U, cv::Scalar::all(grey)));
    grey += 10.0;
  }
}

}  // namespace heel::test
