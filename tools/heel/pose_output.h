// What `heel pose` says of each frame, as JSON or as a table row, and of all of them in one line.
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
  double ms = 0.0;  ///< from frame to pose
};

/// One JSON object on one line, always the same keys: frame, t_s, found, reason, certainty, inliers, yaw_rad,
/// yaw_sigma_rad, t_over_d, position_m, H_cur_from_ref, ms. When not found, the five of the pose are null:
/// numbers from a fit that was rejected would be taken for a pose by someone.
std::string pose_json(const PoseRow& row);

std::string pose_table_head();
std::string pose_table_row(const PoseRow& row);

/// Gathers what the closing line says.
class PoseSummary {
 public:
  void add(const PoseRow& row);
  /// "found 218 of 221 frames (98.6 %), certainty 10/50/90 %: 0.31 0.45 0.58, 12.3 ms a frame (median)"
  std::string line() const;

 private:
  std::uint64_t frames_ = 0;
  std::vector<double> certainties_;  // of the found
  std::vector<double> ms_;
};

}  // namespace heel::cli
