#include "pose_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/angles.h"
#include "evaluation/metrics/metrics.h"

namespace heel::cli {

std::string pose_json(const PoseRow& row) {
  const PoseEstimate& pose = row.pose;
  nlohmann::ordered_json json = {{"frame", row.frame},          {"t_s", row.t_s},
                                 {"found", pose.found()},       {"reason", to_string(pose.reason)},
                                 {"certainty", pose.certainty}, {"inliers", pose.inliers},
                                 {"yaw_rad", nullptr},          {"yaw_sigma_rad", nullptr},
                                 {"frame_yaw_rad", nullptr},    {"frame_yaw_sigma_rad", nullptr},
                                 {"t_over_d", nullptr},         {"position_m", nullptr},
                                 {"H_cur_from_ref", nullptr},   {"ms", row.ms}};
  if (pose.found()) {
    json["yaw_rad"] = pose.yaw_rad;
    json["yaw_sigma_rad"] = pose.yaw_sigma_rad;
    json["frame_yaw_rad"] = pose.frame_yaw_rad;
    json["frame_yaw_sigma_rad"] = pose.frame_yaw_sigma_rad;
    json["t_over_d"] = pose.t_over_d;
    if (pose.has_distance) json["position_m"] = pose.position_m;
    json["H_cur_from_ref"] = pose.H_cur_from_ref;
  }
  if (!row.template_file.empty()) json["template"] = row.template_file;
  return json.dump();
}

std::string pose_table_head() {
  return "  frame      t_s  certainty  inliers     yaw_deg        t_over_d x     y     z   position_m x     "
         "y     z  "
         "    ms";
}

std::string pose_table_row(const PoseRow& row) {
  const PoseEstimate& pose = row.pose;
  std::string text =
      fmt::format("{:7} {:8.3f}  {:9.3f}  {:7}", row.frame, row.t_s, pose.certainty, pose.inliers);
  if (!pose.found()) return text + fmt::format("  -- {:<69}{:6.1f}", to_string(pose.reason), row.ms);
  text += fmt::format("  {:6.1f} ± {:4.1f}        {:6.3f} {:5.3f} {:5.3f}", pose.yaw_rad * kDegPerRad,
                      pose.yaw_sigma_rad * kDegPerRad, pose.t_over_d[0], pose.t_over_d[1], pose.t_over_d[2]);
  if (pose.has_distance) {
    text += fmt::format("         {:5.2f} {:5.2f} {:5.2f}", pose.position_m[0], pose.position_m[1],
                        pose.position_m[2]);
  } else {
    text += fmt::format("{:26}", "");
  }
  return text + fmt::format("  {:6.1f}", row.ms);
}

void PoseSummary::add(const PoseRow& row) {
  ++frames_;
  if (row.pose.found()) certainties_.push_back(row.pose.certainty);
  ms_.push_back(row.ms);
}

std::string PoseSummary::line() const {
  if (frames_ == 0) return "no frames";
  std::string text =
      fmt::format("found in {} of {} frames ({:.1f} %)", certainties_.size(), frames_,
                  100.0 * static_cast<double>(certainties_.size()) / static_cast<double>(frames_));
  if (!certainties_.empty()) {
    text += fmt::format("; certainty where found: 10 % {:.2f}, median {:.2f}, 90 % {:.2f}",
                        evaluation::quantile(certainties_, 0.1), evaluation::quantile(certainties_, 0.5),
                        evaluation::quantile(certainties_, 0.9));
  }
  return text + fmt::format("; median {:.1f} ms a frame", evaluation::quantile(ms_, 0.5));
}

}  // namespace heel::cli
