#include "vision/pose/pose_of_back.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "core/angles.h"
#include "heel/motion.h"

namespace heel {
namespace {

constexpr double kHalfDepth_m = 0.12, kHalfWidth_m = 0.18;  // of a body seen from above
constexpr double kBodySigma_m = 0.03, kTaughtYawSigma_rad = 0.09;

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Eigen::Vector3d centre_m(const ShirtTemplate& shirt) {
  const Eigen::Vector2d centre_px(shirt.roi.x_px + 0.5 * (shirt.roi.width_px - 1),
                                  shirt.roi.y_px + 0.5 * (shirt.roi.height_px - 1));
  return shirt.distance_m * (shirt.camera.K().inverse() * shirt.camera.undistort_px(centre_px).homogeneous());
}

}  // namespace

PoseOfBack::PoseOfBack(const ShirtTemplate& shirt, const ShirtTemplate& first)
    : distance_m_(shirt.distance_m),
      first_distance_m_(first.distance_m),
      R_ref_from_back_(Eigen::AngleAxisd(shirt.yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix()),
      first_centre_m_(centre_m(first)),
      same_(shirt.yaw_rad == 0.0 && distance_m_ == first_distance_m_ && centre_m(shirt) == first_centre_m_) {
  const double support_m =
      std::hypot(kHalfDepth_m * std::cos(shirt.yaw_rad), kHalfWidth_m * std::sin(shirt.yaw_rad));
  back_from_seen_ref_m_ = support_m * Eigen::Vector3d::UnitZ() - kHalfDepth_m * R_ref_from_back_.col(2);
  if (shirt.yaw_rad == 0.0) return;
  yaw_sigma_rad_ = kTaughtYawSigma_rad;
  body_sigma_m_ = kBodySigma_m;
}

PoseEstimate PoseOfBack::in_terms_of_back(const PoseEstimate& pose) const {
  if (same_ || !pose.found()) return pose;
  PoseEstimate of_back = pose;
  const Eigen::Matrix3d R_cur_from_ref = Eigen::Map<const RowMajor3d>(pose.R_cur_from_ref.data());
  const Eigen::Matrix3d R = R_cur_from_ref * R_ref_from_back_;
  const Eigen::Vector3d position_m =
      Eigen::Map<const Eigen::Vector3d>(pose.position_m.data()) + R_cur_from_ref * back_from_seen_ref_m_;
  of_back.frame_yaw_rad = yaw_of_rotation(R);
  of_back.frame_yaw_sigma_rad = std::hypot(pose.frame_yaw_sigma_rad, yaw_sigma_rad_);
  of_back.yaw_rad = wrap_angle_rad(pose.yaw_rad + of_back.frame_yaw_rad - pose.frame_yaw_rad);
  of_back.yaw_sigma_rad = std::hypot(pose.yaw_sigma_rad, yaw_sigma_rad_);
  Eigen::Map<RowMajor3d>(of_back.R_cur_from_ref.data()) = R;
  Eigen::Map<Eigen::Vector3d>(of_back.position_m.data()) = position_m;
  Eigen::Map<Eigen::Vector3d>(of_back.t_over_d.data()) =
      (position_m - R * first_centre_m_) / first_distance_m_;
  for (double& sigma : of_back.t_over_d_sigma)
    sigma = std::hypot(sigma * distance_m_, body_sigma_m_) / first_distance_m_;
  return of_back;
}

}  // namespace heel
