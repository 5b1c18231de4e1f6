// A person as an ellipse seen from above, at every turn: the side that a template shows leads to the back.
#include "vision/pose/pose_of_back.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/pose_bytes.h"
#include "vision/pose/rendered_shirt.h"

namespace heel {
namespace {

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Eigen::Matrix3d turned(double yaw_rad) {
  return test::rotation(yaw_rad, 0.0, 0.0);
}

/// The point of the ellipse whose normal points towards the camera when the person is turned by `taught_rad`:
/// seen from the axis, in the reference view's frame.
Eigen::Vector3d support_point_m(double taught_rad) {
  // In the person's own frame, z being the walking direction, the normal is −z turned back by taught_rad.
  const Eigen::Vector3d normal = turned(-taught_rad) * -Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d squares(0.18 * 0.18 * normal.x(), 0.0, 0.12 * 0.12 * normal.z());
  return turned(taught_rad) * (squares / std::sqrt(normal.dot(squares)));
}

TEST(PoseOfBack, SidesAndFrontLeadToTheBack) {
  const ShirtTemplate first = test::shirt();
  for (const double taught_deg : {0.0, 90.0, -90.0, 180.0}) {
    ShirtTemplate shirt = test::shirt();
    shirt.yaw_rad = taught_deg * M_PI / 180.0;
    shirt.distance_m = 1.5;
    const PoseOfBack pose_of_back(shirt, first);
    for (const double yaw_rad : {-0.6, 0.0, 0.5}) {  // from the view in which it was taught
      const Eigen::Vector3d axis_m(0.3, 0.1, 2.5);
      const Eigen::Matrix3d R_cur_from_ref = turned(yaw_rad);
      PoseEstimate pose;
      pose.reason = PoseReason::Found;
      pose.has_distance = true;
      pose.yaw_sigma_rad = 0.03;
      Eigen::Map<RowMajor3d>(pose.R_cur_from_ref.data()) = R_cur_from_ref;
      Eigen::Map<Eigen::Vector3d>(pose.position_m.data()) =
          axis_m + R_cur_from_ref * support_point_m(shirt.yaw_rad);

      const PoseEstimate back = pose_of_back.in_terms_of_back(pose);
      const Eigen::Matrix3d R = turned(yaw_rad + shirt.yaw_rad);
      const Eigen::Vector3d truth_m = axis_m - 0.12 * R.col(2);
      const Eigen::Map<const Eigen::Vector3d> position_m(back.position_m.data());
      EXPECT_LT((position_m - truth_m).norm(), 1e-9) << taught_deg << " deg, turned by " << yaw_rad;
      EXPECT_NEAR(std::remainder(back.yaw_rad - yaw_rad - shirt.yaw_rad, 2.0 * M_PI), 0.0, 1e-9);
      EXPECT_LT((Eigen::Map<const RowMajor3d>(back.R_cur_from_ref.data()) - R).norm(), 1e-9);
      // The middle of the first template's region, moved by the motion that the pose states.
      const Eigen::Vector3d centre_m =
          2.0 * (first.camera.K().inverse() * first.camera.undistort_px({319.5, 239.5}).homogeneous());
      const Eigen::Vector3d moved_m =
          R * centre_m + 2.0 * Eigen::Map<const Eigen::Vector3d>(back.t_over_d.data());
      EXPECT_LT((moved_m - truth_m).norm(), 1e-9) << taught_deg << " deg, turned by " << yaw_rad;
    }
  }
}

TEST(PoseOfBack, NothingChangesForTheFirstTemplate) {
  PoseEstimate pose;
  pose.reason = PoseReason::Found;
  pose.yaw_rad = 0.1;
  pose.t_over_d = {0.1, 0.2, 0.3};
  const PoseOfBack same(test::shirt(), test::shirt());
  EXPECT_EQ(test::pose_bytes(same.in_terms_of_back(pose)), test::pose_bytes(pose));
}

TEST(PoseOfBack, APoseThatIsNotFoundStaysAsItIs) {
  ShirtTemplate side = test::shirt();
  side.yaw_rad = M_PI_2;
  PoseEstimate pose;
  pose.reason = PoseReason::TooFewMatches;
  EXPECT_EQ(test::pose_bytes(PoseOfBack(side, test::shirt()).in_terms_of_back(pose)), test::pose_bytes(pose));
}

}  // namespace
}  // namespace heel
