// The output of `heel pose`: for each frame a JSON object or a row of a table, and one line about all frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "heel/flow.h"

namespace heel::cli {

struct PoseRow {
  std::uint64_t frame = 0;
  double t_s = 0.0;
  PoseEstimate pose;
  double ms = 0.0;            ///< from frame to pose
  std::string template_file;  ///< by which it was found, or searched; empty: there is only one
};

/// One JSON object on one line, always with the same keys: frame, t_s, found, reason, certainty, inliers,
/// yaw_rad, yaw_sigma_rad, frame_yaw_rad, frame_yaw_sigma_rad, t_over_d, position_m, H_cur_from_ref, ms; then
/// template, if there are several. When the shirt is not found, those of the pose are null, so that numbers
/// of a rejected fit are not taken for a pose.
std::string pose_json(const PoseRow& row);

std::string pose_table_head();
std::string pose_table_row(const PoseRow& row);

/// Collects the figures of the closing line.
class PoseSummary {
 public:
  void add(const PoseRow& row);
  /// "found in 218 of 221 frames (98.6 %); certainty where found: 10 % 0.31, median 0.45, 90 % 0.58;
  /// median 12.3 ms a frame"
  std::string line() const;

 private:
  std::uint64_t frames_ = 0;
  std::vector<double> certainties_;  ///< of the frames in which the shirt was found
  std::vector<double> ms_;
};

}  // namespace heel::cli
