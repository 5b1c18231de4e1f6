#include "evaluation/reports/fit_rows.h"

#include <cmath>
#include <functional>
#include <string>

#include "core/angles.h"

namespace heel::evaluation {
namespace {

/// On the floor of the camera frame.
struct Seen {
  double x_m, z_m, yaw_rad;
};

/// ViewConditions of the pose alone, and the errors of what was found.
sim::FitRow row_of(const Seen& truth, const Seen& estimate, bool found, const CameraModel& camera,
                   double occluded) {
  sim::FitRow row;
  row.conditions = sim::conditions_of(truth.x_m, truth.z_m, truth.yaw_rad, camera.fx, camera.cx,
                                      camera.width_px, occluded);
  row.found = found;
  if (!found) return row;
  const double bearing_rad = std::atan2(estimate.x_m, estimate.z_m);
  const double aspect_rad = wrap_angle_rad(estimate.yaw_rad - bearing_rad);
  row.aspect_error_rad = wrap_angle_rad(aspect_rad - row.conditions.aspect_rad);
  row.bearing_error_rad = bearing_rad - std::atan2(truth.x_m, truth.z_m);
  row.range_error_share = std::hypot(estimate.x_m, estimate.z_m) / row.conditions.distance_m - 1.0;
  row.flipped = std::abs(row.conditions.aspect_rad) > kLeastFlipAspect_rad &&
                aspect_rad * row.conditions.aspect_rad < 0.0;
  return row;
}

}  // namespace

std::vector<sim::FitRow> still_fit_rows(const std::vector<StillSample>& samples, const CameraModel& camera) {
  std::vector<sim::FitRow> rows;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const StillSample& s = samples[i];
    sim::FitRow row = row_of({s.true_x_m, s.true_z_m, s.true_yaw_rad}, {s.x_est_m, s.z_est_m, s.yaw_est_rad},
                             s.found, camera, s.occluded);
    row.conditions.blur_px = s.blur_px;
    row.conditions.light = s.light;
    // Decided by the picture before, not by whether tracking worked.
    row.conditions.whole_frame_search = s.whole_frame_search || i == 0 || !samples[i - 1].found;
    row.conditions.other_print = s.shirt != "bold";
    row.world = std::hash<std::string>{}(s.shirt) ^ s.seed;
    row.certainty = s.certainty;
    row.yaw_sigma_rad = s.yaw_sigma_rad;
    row.vision_ms = s.vision_ms;
    rows.push_back(row);
  }
  return rows;
}

std::vector<sim::FitRow> walk_fit_rows(const MetricsCollector& run, const CameraModel& camera) {
  const FollowMetrics metrics = run.evaluate();
  std::vector<sim::FitRow> rows;
  for (const PoseSample& pose : run.poses()) {
    if (!pose.has_truth || pose.t_s < metrics.t_walk_begin_s || pose.t_s > metrics.t_walk_end_s) continue;
    sim::FitRow row = row_of({pose.true_x_m, pose.true_z_m, pose.true_yaw_rad},
                             {pose.x_m, pose.z_m, pose.yaw_rad}, pose.found, camera, 0.0);
    row.t_s = pose.t_s;
    row.certainty = pose.certainty;
    row.yaw_sigma_rad = pose.yaw_sigma_rad;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace heel::evaluation
