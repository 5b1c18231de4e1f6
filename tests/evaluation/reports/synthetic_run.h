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

inline std::string ticks_csv() {
  std::string text = "t_s,tick,stop_reason,command_v_m_s,command_yaw_rate_rad_s\n";
  for (int i = 0; i <= 100; ++i) {
    const char* reason = i >= 95 ? "shutting down" : i >= 30 && i < 35 ? "target lost" : "following";
    text += printed("%.1f,%d,%s,%.1f,-0.2\n", kClock_s + 0.1 * i, i, reason, reason[0] == 'f' ? 0.5 : 0.0);
  }
  return text;
}

inline std::string poses_csv() {
  std::string text =
      "t_s,frame,reason,found,certainty,yaw_rad,frame_yaw_rad,frame_yaw_sigma_rad,position_m_0,position_m_1,"
      "position_m_2";
  for (int i = 0; i < 9; ++i) text += ",H_cur_from_ref_" + std::to_string(i);
  for (int k = 0; k < 100; ++k) {
    const double t_s = kClock_s + 0.1 * k + 0.05;
    if (k >= 50 && k < 55) {
      text += printed("\n%.2f,%d,too few inliers,0,0.02,nan,nan,nan,nan,nan,nan,0,0,0,0,0,0,0,0,0", t_s, k);
      continue;
    }
    const double yaw_rad = 0.02 * (k + 0.5) + (k % 2 == 0 ? kEvenYawError_rad : kOddYawError_rad);
    text += printed("\n%.2f,%d,found,1,0.3,%.3f,%.3f,%.1f,0,-0.1,%.2f,1,0,0,0,1,0,0,0,1", t_s, k, yaw_rad,
                    yaw_rad, kYawSigma_rad, 2.0 + kZError_m);
  }
  return text + "\n";
}

inline void write_run(const TemporaryFolder& folder) {
  write_text(folder.file("truth.csv"), truth_csv());
  write_text(folder.file("ticks.csv"), ticks_csv());
  write_text(folder.file("poses.csv"), poses_csv());
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
