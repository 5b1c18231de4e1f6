// Poses as text (see pose_output.h).
#include "pose_output.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

namespace heel::cli {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

/// Nearest-rank quantile; 0 of nothing.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  return values[rank];
}

}  // namespace

std::string pose_json(const PoseRow& row) {
  const PoseEstimate& pose = row.pose;
  nlohmann::ordered_json json = {{"frame", row.frame},          {"t_s", row.t_s},
                                 {"found", pose.found()},       {"reason", to_string(pose.reason)},
                                 {"certainty", pose.certainty}, {"inliers", pose.inliers},
                                 {"yaw_rad", nullptr},          {"yaw_sigma_rad", nullptr},
                                 {"t_over_d", nullptr},         {"position_m", nullptr},
                                 {"H_cur_from_ref", nullptr},   {"ms", row.ms}};
  if (pose.found()) {
    json["yaw_rad"] = pose.yaw_rad;
    json["yaw_sigma_rad"] = pose.yaw_sigma_rad;
    json["t_over_d"] = pose.t_over_d;
    if (pose.has_distance) json["position_m"] = pose.position_m;
    json["H_cur_from_ref"] = pose.H_cur_from_ref;
  }
  return json.dump();
}

std::string pose_table_head() {
  return "  frame      t_s  certainty  inliers     yaw_deg        t_over_d x     y     z   position_m x     "
         "y     z  "
         "    ms";
}

std::string pose_table_row(const PoseRow& row) {
  const PoseEstimate& pose = row.pose;
  std::string text = format("%7llu %8.3f  %9.3f  %7u", static_cast<unsigned long long>(row.frame), row.t_s,
                            pose.certainty, pose.inliers);
  if (!pose.found()) return text + format("  -- %-69s%6.1f", to_string(pose.reason), row.ms);
  text += format("  %6.1f ± %4.1f        %6.3f %5.3f %5.3f", pose.yaw_rad * kDegPerRad,
                 pose.yaw_sigma_rad * kDegPerRad, pose.t_over_d[0], pose.t_over_d[1], pose.t_over_d[2]);
  if (pose.has_distance) {
    text += format("         %5.2f %5.2f %5.2f", pose.position_m[0], pose.position_m[1], pose.position_m[2]);
  } else {
    text += format("%26s", "");
  }
  return text + format("  %6.1f", row.ms);
}

void PoseSummary::add(const PoseRow& row) {
  ++frames_;
  if (row.pose.found()) certainties_.push_back(row.pose.certainty);
  ms_.push_back(row.ms);
}

std::string PoseSummary::line() const {
  if (frames_ == 0) return "no frames";
  std::string text = format("found in %zu of %llu frames (%.1f %%)", certainties_.size(),
                            static_cast<unsigned long long>(frames_),
                            100.0 * static_cast<double>(certainties_.size()) / static_cast<double>(frames_));
  if (!certainties_.empty()) {
    text += format("; certainty where found: 10 %% %.2f, median %.2f, 90 %% %.2f",
                   quantile(certainties_, 0.1), quantile(certainties_, 0.5), quantile(certainties_, 0.9));
  }
  return text + format("; median %.1f ms a frame", quantile(ms_, 0.5));
}

}  // namespace heel::cli
