// The truth of one picture of a test set of backs, and its row of truth.csv.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "evaluation/experiments/back_set_plan.h"
#include "heel/features.h"
#include "sim/scene/world.h"

namespace heel::evaluation {

/// The reference view of one person: what heel teach is told, and the cloth that it shows.
struct TaughtBack {
  Region roi;
  double distance_m = 0.0;  ///< of the cloth in the middle of the region
  Eigen::Isometry3d view_from_world = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> points_m;              ///< World::back_points_m, camera frame
  double centre_s_texel = 0.0, centre_t_texel = 0.0;  ///< the cloth in the middle of the region
};

/// `pose` in the view `view_from_world` is the reference view with the region `roi`.
TaughtBack taught_back(const sim::World& world, const sim::PersonPose& pose,
                       const Eigen::Isometry3d& view_from_world, const Region& roi);

struct BackTruth {
  // Angles against the taught picture, camera frame: R = Ry(yaw) Rx(pitch) Rz(roll).
  double yaw_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
  double fit_rms_mm = 0.0, fit_rms_depth_mm = 0.0;  ///< what the rigid fit leaves: all, and along the normal
  double yaw_chest_deg = 0.0, yaw_hips_deg = 0.0, yaw_walk_deg = 0.0;
  Eigen::Vector3d centre_m{0, 0, 0};  ///< camera frame
  Eigen::Vector2d centre_px{0, 0};
};

BackTruth back_truth(const sim::World& world, const sim::PersonPose& pose,
                     const Eigen::Isometry3d& view_from_world, const TaughtBack& taught);

struct BackRow {
  BackPicture picture;
  TaughtBack taught;
  BackTruth truth;
};

/// Throws heel::Error when it cannot be written.
void write_back_truth(const std::vector<BackRow>& rows, double camera_height_m, const std::string& path);

}  // namespace heel::evaluation
