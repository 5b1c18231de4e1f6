#include "heel/camera_model.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "vision/lens/lens_fold.h"
#include "vision/pose/scene.h"

namespace heel {
namespace {

using test::plain_camera;
using test::Random;

CameraModel random_lens(Random& random) {
  CameraModel camera = plain_camera();
  camera.k1 = random.uniform(-0.35, 0.35);
  camera.k2 = random.uniform(0.0, 0.15);
  camera.k3 = random.uniform(-0.02, 0.02);
  camera.p1 = random.uniform(-0.003, 0.003);
  camera.p2 = random.uniform(-0.003, 0.003);
  return camera;
}

TEST(CameraModel, KHoldsTheIntrinsics) {
  const Eigen::Matrix3d K = plain_camera().K();
  const Eigen::Vector3d pixel = K * Eigen::Vector3d(0.1, -0.2, 1.0);
  EXPECT_DOUBLE_EQ(pixel.x(), 600.0 * 0.1 + 322.5);
  EXPECT_DOUBLE_EQ(pixel.y(), 605.0 * -0.2 + 238.0);
  EXPECT_DOUBLE_EQ(pixel.z(), 1.0);
}

TEST(CameraModel, WithoutDistortionPixelsDoNotChange) {
  const CameraModel camera = plain_camera();
  const Eigen::Vector2d pixel(12.25, 400.5);
  EXPECT_EQ(camera.undistort_px(pixel), pixel);
  EXPECT_EQ(camera.distort_px(pixel), pixel);
}

RC_GTEST_PROP(CameraModel, RoundTripWithin1e9Px, (std::uint64_t seed)) {
  Random random(seed);
  const CameraModel camera = random_lens(random);
  const Eigen::Vector2d undistorted(random.uniform(0, 640), random.uniform(0, 480));
  const Eigen::Vector2d distorted = camera.distort_px(undistorted);
  RC_ASSERT((camera.undistort_px(distorted) - undistorted).norm() < 1e-9);
}

TEST(CameraModel, AgreesWithOpenCvBothWays) {
  int undistorted_by_opencv = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const CameraModel camera = random_lens(random);
    const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const cv::Vec<double, 5> D(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
    std::vector<cv::Point2d> distorted, undistorted;
    for (int i = 0; i < 20; ++i) distorted.emplace_back(random.uniform(0, 640), random.uniform(0, 480));
    cv::undistortPoints(distorted, undistorted, K, D, cv::noArray(), K,
                        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-13));
    std::vector<cv::Point3d> rays;
    for (const cv::Point2d& p : undistorted)
      rays.emplace_back((p.x - camera.cx) / camera.fx, (p.y - camera.cy) / camera.fy, 1.0);
    std::vector<cv::Point2d> again;
    cv::projectPoints(rays, cv::Vec3d(), cv::Vec3d(), K, D, again);
    for (std::size_t i = 0; i < distorted.size(); ++i) {
      const Eigen::Vector2d ours = camera.undistort_px({distorted[i].x, distorted[i].y});
      const Eigen::Vector2d ours_again = camera.distort_px({undistorted[i].x, undistorted[i].y});
      EXPECT_NEAR(ours_again.x(), again[i].x, 1e-9) << "seed " << seed;
      EXPECT_NEAR(ours_again.y(), again[i].y, 1e-9) << "seed " << seed;
      // OpenCV's fixed-point iteration does not always converge; where it does, the result must be the same.
      if (cv::norm(again[i] - distorted[i]) > 1e-9) continue;
      ++undistorted_by_opencv;
      EXPECT_NEAR(ours.x(), undistorted[i].x, 1e-7) << "seed " << seed;
      EXPECT_NEAR(ours.y(), undistorted[i].y, 1e-7) << "seed " << seed;
    }
  }
  EXPECT_GT(undistorted_by_opencv, 200 * 20 / 2);
}

/// As OpenCV's rational model and real wide lenses have it.
CameraModel rational_lens(Random& random) {
  CameraModel camera = random_lens(random);
  camera.fx = camera.fy = 340.0;
  camera.lens = LensModel::Rational;
  camera.k1 = random.uniform(0.2, 0.6);
  camera.k2 = random.uniform(-0.05, 0.05);
  camera.k3 = random.uniform(0.0, 0.01);
  camera.k4 = camera.k1 + random.uniform(0.2, 0.4);
  camera.k5 = random.uniform(0.0, 0.1);
  camera.k6 = random.uniform(0.0, 0.02);
  return fold_in_picture_px(camera) ? rational_lens(random) : camera;
}

CameraModel fisheye_lens(Random& random) {
  CameraModel camera = plain_camera();
  camera.fx = camera.fy = 300.0;  // 122° across, 154° from corner to corner
  camera.lens = LensModel::Fisheye;
  camera.k1 = random.uniform(-0.05, 0.05);
  camera.k2 = random.uniform(-0.01, 0.02);
  camera.k3 = random.uniform(-0.005, 0.005);
  camera.k4 = random.uniform(-0.001, 0.001);
  return camera;
}

TEST(CameraModel, TheRationalModelAgreesWithOpenCvBothWays) {
  int undistorted_by_opencv = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    const CameraModel camera = rational_lens(random);
    const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const cv::Vec<double, 8> D(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3, camera.k4, camera.k5,
                               camera.k6);
    std::vector<cv::Point2d> distorted, undistorted, again;
    for (int i = 0; i < 20; ++i) distorted.emplace_back(random.uniform(0, 640), random.uniform(0, 480));
    cv::undistortPoints(distorted, undistorted, K, D, cv::noArray(), K,
                        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-13));
    std::vector<cv::Point3d> rays;
    for (const cv::Point2d& p : undistorted)
      rays.emplace_back((p.x - camera.cx) / camera.fx, (p.y - camera.cy) / camera.fy, 1.0);
    cv::projectPoints(rays, cv::Vec3d(), cv::Vec3d(), K, D, again);
    for (std::size_t i = 0; i < distorted.size(); ++i) {
      const Eigen::Vector2d ours = camera.undistort_px({distorted[i].x, distorted[i].y});
      const Eigen::Vector2d ours_again = camera.distort_px({undistorted[i].x, undistorted[i].y});
      EXPECT_LT(std::hypot(ours_again.x() - again[i].x, ours_again.y() - again[i].y), 1e-9)
          << "seed " << seed;
      EXPECT_LT((camera.distort_px(ours) - Eigen::Vector2d(distorted[i].x, distorted[i].y)).norm(), 1e-9);
      if (cv::norm(again[i] - distorted[i]) > 1e-9) continue;
      ++undistorted_by_opencv;
      EXPECT_LT(std::hypot(ours.x() - undistorted[i].x, ours.y() - undistorted[i].y), 1e-6)
          << "seed " << seed;
    }
  }
  EXPECT_GT(undistorted_by_opencv, 100 * 20 / 2);
}

TEST(CameraModel, TheFisheyeModelAgreesWithOpenCvBothWays) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    const CameraModel camera = fisheye_lens(random);
    const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const cv::Vec4d D(camera.k1, camera.k2, camera.k3, camera.k4);
    std::vector<cv::Point2d> distorted, undistorted, again;
    for (int i = 0; i < 20; ++i) distorted.emplace_back(random.uniform(0, 640), random.uniform(0, 480));
    cv::fisheye::undistortPoints(distorted, undistorted, K, D, cv::noArray(), K);
    std::vector<cv::Point2d> normalised;
    for (const cv::Point2d& p : undistorted)
      normalised.emplace_back((p.x - camera.cx) / camera.fx, (p.y - camera.cy) / camera.fy);
    cv::fisheye::distortPoints(normalised, again, K, D);
    for (std::size_t i = 0; i < distorted.size(); ++i) {
      const Eigen::Vector2d ours = camera.undistort_px({distorted[i].x, distorted[i].y});
      const Eigen::Vector2d ours_again = camera.distort_px({undistorted[i].x, undistorted[i].y});
      EXPECT_LT(std::hypot(ours_again.x() - again[i].x, ours_again.y() - again[i].y), 1e-9)
          << "seed " << seed;
      EXPECT_LT((camera.distort_px(ours) - Eigen::Vector2d(distorted[i].x, distorted[i].y)).norm(), 1e-9);
      // OpenCV ends its iteration at 1e-8 rad; the tangent makes more of it at the edge.
      const double scale =
          1.0 + std::pow((ours - Eigen::Vector2d(camera.cx, camera.cy)).norm() / camera.fx, 2);
      EXPECT_LT(std::hypot(ours.x() - undistorted[i].x, ours.y() - undistorted[i].y), 1e-5 * scale)
          << "seed " << seed;
    }
  }
}

TEST(CameraModel, BeyondTheHalfSpaceInFrontAFisheyeLensGivesAFinitePlace) {
  Random random(1);
  CameraModel camera = fisheye_lens(random);
  camera.fx = camera.fy = 150.0;  // 240° across
  const Eigen::Vector2d corner = camera.undistort_px({0, 0});
  EXPECT_TRUE(corner.allFinite());
  EXPECT_LT(corner.x(), -1000.0);
  EXPECT_EQ(camera.undistort_px({camera.cx, camera.cy}), Eigen::Vector2d(camera.cx, camera.cy));
}

TEST(LensFold, IsFoundInEachModelAndNowhereInRealLenses) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    for (const CameraModel& camera :
         {plain_camera(), random_lens(random), rational_lens(random), fisheye_lens(random)})
      EXPECT_FALSE(fold_in_picture_px(camera).has_value()) << "seed " << seed;
  }
  CameraModel barrel = plain_camera();
  barrel.k1 = -1.5;  // 1 + 3 k1 r² = 0 at r = 0.471, seen at 0.314 focal lengths
  ASSERT_TRUE(fold_in_picture_px(barrel).has_value());
  EXPECT_NEAR(*fold_in_picture_px(barrel), 0.314 * 600.0, 3.0);
  CameraModel rational = barrel;
  rational.lens = LensModel::Rational;
  rational.k4 = 0.1;
  EXPECT_TRUE(fold_in_picture_px(rational).has_value());
  CameraModel fisheye = plain_camera();
  fisheye.lens = LensModel::Fisheye;
  fisheye.k1 = -1.5;
  EXPECT_TRUE(fold_in_picture_px(fisheye).has_value());
  CameraModel mild = plain_camera();
  mild.k1 = -0.6;  // folds at 0.497 focal lengths × 600 px = 298 px, which the corners are beyond
  EXPECT_TRUE(fold_in_picture_px(mild).has_value());
  mild.k1 = -0.25;  // 462 px: outside
  EXPECT_FALSE(fold_in_picture_px(mild).has_value());
}

// Also pixels to which no direction maps (beyond the fold of a strong barrel distortion), and numbers that
// are no pixels.
RC_GTEST_PROP(CameraModel, UndistortIsTotal, (std::uint64_t seed)) {
  Random random(seed);
  CameraModel camera = plain_camera();
  camera.k1 = random.uniform(-2.0, 2.0);
  camera.k2 = random.uniform(-2.0, 2.0);
  camera.k3 = random.uniform(-2.0, 2.0);
  camera.p1 = random.uniform(-0.1, 0.1);
  camera.p2 = random.uniform(-0.1, 0.1);
  const Eigen::Vector2d pixel(random.uniform(-2000, 3000), random.uniform(-2000, 3000));
  const Eigen::Vector2d result = camera.undistort_px(pixel);
  RC_ASSERT(result.allFinite());
  // The error is never larger than that of the pixel itself or of the principal point.
  const double error = (camera.distort_px(result) - pixel).norm();
  const double from_centre = (Eigen::Vector2d(camera.cx, camera.cy) - pixel).norm();
  RC_ASSERT(error <= std::max((camera.distort_px(pixel) - pixel).norm(), from_centre * 1.02) + 1e-9);
}

TEST(CameraModel, NotANumberRemainsNotANumber) {
  CameraModel camera = plain_camera();
  camera.k1 = -0.2;
  EXPECT_FALSE(camera.undistort_px({std::numeric_limits<double>::quiet_NaN(), 3.0}).allFinite());
}

}  // namespace
}  // namespace heel
