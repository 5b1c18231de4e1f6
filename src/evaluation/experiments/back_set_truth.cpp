#include "evaluation/experiments/back_set_truth.h"

#include <cmath>

#include "core/angles.h"
#include "files/csv_file.h"
#include "sim/scene/rigid_fit.h"
#include "sim/scene/shirts.h"

namespace heel::evaluation {
namespace {

/// Yaw of a horizontal direction of the world, as PoseEstimate::yaw_rad.
double yaw_in_view_deg(const Eigen::Isometry3d& view_from_world, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d in_view = view_from_world.linear() * direction;
  return std::atan2(in_view.x(), in_view.z()) / kRadPerDeg;
}

std::vector<Eigen::Vector3d> back_in_view(const sim::World& world, const sim::PersonPose& pose,
                                          const Eigen::Isometry3d& view_from_world) {
  std::vector<Eigen::Vector3d> points = world.back_points_m(pose);
  for (Eigen::Vector3d& point : points) point = view_from_world * point;
  return points;
}

Eigen::Vector3d shirt_point_in_view(const sim::World& world, const sim::PersonPose& pose,
                                    const Eigen::Isometry3d& view_from_world, double s_texel,
                                    double t_texel) {
  return view_from_world *
         (pose.world_from_part[sim::kTorso] * world.person().shirt_point_m(s_texel, t_texel, pose.cloth));
}

}  // namespace

TaughtBack taught_back(const sim::World& world, const sim::PersonPose& pose,
                       const Eigen::Isometry3d& view_from_world, const Region& roi) {
  TaughtBack taught;
  taught.roi = roi;
  taught.view_from_world = view_from_world;
  taught.points_m = back_in_view(world, pose, view_from_world);
  const Eigen::Vector2d wanted_px(roi.x_px + 0.5 * (roi.width_px - 1), roi.y_px + 0.5 * (roi.height_px - 1));
  taught.centre_s_texel = 0.5 * sim::kShirtWidthTexels;
  taught.centre_t_texel = 355.0;
  const double focal_px = world.scenario().camera.model.fx;
  // The cloth is nearly square to the view, so that a few steps are exact.
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d at =
        shirt_point_in_view(world, pose, view_from_world, taught.centre_s_texel, taught.centre_t_texel);
    const Eigen::Vector2d off_m = (wanted_px - world.project_px(at)) * at.z() / focal_px;
    taught.centre_s_texel += sim::kShirtTexelsPerM * off_m.x();
    taught.centre_t_texel += sim::kShirtTexelsPerM * off_m.y();
    taught.distance_m = at.z();
  }
  return taught;
}

BackTruth back_truth(const sim::World& world, const sim::PersonPose& pose,
                     const Eigen::Isometry3d& view_from_world, const TaughtBack& taught) {
  BackTruth truth;
  const std::vector<Eigen::Vector3d> now = back_in_view(world, pose, view_from_world);
  const sim::RigidFit fit = sim::fit_rigid(taught.points_m, now);
  const Eigen::Matrix3d& R = fit.R;
  truth.yaw_deg = std::atan2(R(0, 2), R(2, 2)) / kRadPerDeg;
  truth.pitch_deg = std::asin(std::clamp(-R(1, 2), -1.0, 1.0)) / kRadPerDeg;
  truth.roll_deg = std::atan2(R(1, 0), R(1, 1)) / kRadPerDeg;
  double all2 = 0.0, depth2 = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Eigen::Vector3d off = R.transpose() * (now[i] - fit.t_m) - taught.points_m[i];
    all2 += off.squaredNorm();
    depth2 += off.z() * off.z();
  }
  truth.fit_rms_mm = 1e3 * std::sqrt(all2 / static_cast<double>(now.size()));
  truth.fit_rms_depth_mm = 1e3 * std::sqrt(depth2 / static_cast<double>(now.size()));
  const auto heading_of = [&](sim::PersonPart part) -> Eigen::Vector3d {
    return pose.world_from_part[part].linear().col(0);
  };
  truth.yaw_chest_deg = yaw_in_view_deg(view_from_world, heading_of(sim::kTorso));
  truth.yaw_hips_deg = yaw_in_view_deg(view_from_world, pose.hips_forwards);
  truth.yaw_walk_deg = yaw_in_view_deg(
      view_from_world, {std::cos(pose.walk.heading_rad), std::sin(pose.walk.heading_rad), 0.0});
  truth.centre_m =
      shirt_point_in_view(world, pose, view_from_world, taught.centre_s_texel, taught.centre_t_texel);
  truth.centre_px = world.project_px(truth.centre_m);
  return truth;
}

void write_back_truth(const std::vector<BackRow>& rows, double camera_height_m, const std::string& path) {
  CsvFile file(
      path,
      "image,kind,build,print,pose,room,t_s,distance_m,yaw_set_deg,yaw_back_deg,pitch_back_deg,"
      "roll_back_deg,back_fit_rms_mm,back_fit_rms_depth_mm,yaw_print_deg,yaw_chest_deg,yaw_pelvis_deg,"
      "yaw_walk_deg,centre_x_m,centre_y_m,centre_z_m,centre_u_px,centre_v_px,bearing_deg,roi_x,roi_y,"
      "roi_w,roi_h,teach_distance_m,camera_height_m");
  for (const auto& [picture, taught, truth] : rows) {
    for (const std::string* cell :
         {&picture.image, &picture.kind, &picture.build, &picture.print, &picture.pose, &picture.room})
      file.text(*cell);
    for (const double value :
         {picture.t_s, picture.distance_m, picture.yaw_deg, truth.yaw_deg, truth.pitch_deg, truth.roll_deg,
          truth.fit_rms_mm, truth.fit_rms_depth_mm, truth.yaw_deg, truth.yaw_chest_deg, truth.yaw_hips_deg,
          truth.yaw_walk_deg, truth.centre_m.x(), truth.centre_m.y(), truth.centre_m.z(), truth.centre_px.x(),
          truth.centre_px.y(), picture.bearing_deg})
      file.number(value, 4);
    for (const int value : {taught.roi.x_px, taught.roi.y_px, taught.roi.width_px, taught.roi.height_px})
      file.number(value, 0);
    file.number(taught.distance_m, 4).number(camera_height_m, 2);
    file.end_row();
  }
  file.flush();
}

}  // namespace heel::evaluation
