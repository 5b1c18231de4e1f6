// A pose estimate as bytes, for tests that compare two to the bit.
#pragma once

#include <string>

#include "heel/flow.h"

namespace heel::test {

/// Field by field: a struct has padding between them. Without the time at which vision finished.
inline std::string pose_bytes(const PoseEstimate& pose) {
  std::string bytes;
  const auto append = [&bytes](const auto&... fields) {
    (bytes.append(reinterpret_cast<const char*>(&fields), sizeof fields), ...);
  };
  append(pose.frame_sequence, pose.t_capture_ns, pose.reason, pose.template_index, pose.tracked,
         pose.frame_features, pose.template_features, pose.matches, pose.inliers, pose.certainty,
         pose.yaw_rad, pose.yaw_sigma_rad, pose.frame_yaw_rad, pose.frame_yaw_sigma_rad, pose.t_over_d,
         pose.t_over_d_sigma, pose.R_cur_from_ref, pose.has_distance, pose.position_m, pose.H_cur_from_ref);
  return bytes;
}

}  // namespace heel::test
