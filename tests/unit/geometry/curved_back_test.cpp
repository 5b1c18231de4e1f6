// The pose of a curved back: exact, honest and rarely mirrored where a plane's is not, and found again from
// one facet.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "allocation_count.h"
#include "scene.h"
#include "vision/back_surface.h"
#include "vision/motion_refine.h"
#include "vision/surface_follower.h"

namespace {

using heel::BackSurface;
using heel::FrontalMotion;
using heel::FrontalPose;
using heel::FrontalPoseEstimator;
using heel::FrontalProblem;
using heel::PlaneMotion;
using heel::PointPair;
using heel_test::plain_camera;
using heel_test::Random;
using heel_test::random_view;
using heel_test::View;

const Eigen::Matrix3d K = plain_camera().K();
const Eigen::Matrix3d K_inverse = K.inverse();
const Eigen::Vector2d kCentrePx(320.0, 240.0);  // of the region in which heel_test::inlier_pairs lie

/// A back at 1.5 m with the given curvature κ, which departs from its curve by `shape_sigma_m`.
BackSurface back(double curvature_1_m, double shape_sigma_m = 0.0) {
  constexpr double kDistanceM = 1.5;
  BackSurface surface;
  surface.bend = curvature_1_m * kDistanceM;
  surface.axis_x = (K_inverse * kCentrePx.homogeneous()).x();
  surface.axis_y = (K_inverse * kCentrePx.homogeneous()).y();
  surface.half_size = {100.0 / 600.0, 150.0 / 605.0};
  surface.shape_sigma = shape_sigma_m / kDistanceM;
  return surface;
}

/// Points of the region of `surface` seen in both views; `departures` times its five shapes added to it.
std::vector<PointPair> pairs_on(const BackSurface& surface, Random& random, const View& view, int count,
                                double noise_px, const heel::Vector5d& departures = heel::Vector5d::Zero()) {
  std::vector<PointPair> pairs;
  while (static_cast<int>(pairs.size()) < count) {
    const Eigen::Vector2d ref(random.uniform(220.0, 420.0), random.uniform(90.0, 390.0));
    const Eigen::Vector3d ray = K_inverse * ref.homogeneous();
    const Eigen::Matrix3d KR = K * view.R;
    // The far side of a turned back is not seen.
    if (heel::image_derivative(surface, K_inverse, KR, K * view.t_over_d, ray).determinant() <= 0.0) continue;
    const Eigen::Vector3d point =
        surface.point(ray) + departures.dot(surface.departures(ray)) * Eigen::Vector3d::UnitZ();
    pairs.push_back({ref + random.normal2(noise_px),
                     (KR * point + K * view.t_over_d).hnormalized() + random.normal2(noise_px)});
  }
  return pairs;
}

heel::Vector5d drawn_departures(Random& random) {
  heel::Vector5d a;
  for (int i = 0; i < 5; ++i) a(i) = random.normal(1.0);
  return a;
}

FrontalProblem problem_of(const std::vector<PointPair>& pairs, const View& view, const BackSurface& surface) {
  return {pairs, K, K, view.H, kCentrePx, surface};
}

PlaneMotion motion_of(const View& view) {
  PlaneMotion motion;
  motion.R_cur_from_ref = view.R;
  motion.t_over_d = view.t_over_d;
  return motion;
}

PlaneMotion mirrored(const View& view) {
  FrontalMotion motion;
  motion.R_cur_from_ref = view.R;
  motion.t_over_d = view.t_over_d;
  return heel::mirrored_motion(problem_of({}, view, {}), motion);
}

View view_at(double yaw_rad, double depth) {
  View view;
  view.R = heel_test::rotation(yaw_rad, 0.0, 0.0);
  view.t_over_d = Eigen::Vector3d(0, 0, depth) - view.R.col(2);
  view.H = heel_test::homography_of(K, K, view.R, view.t_over_d);
  return view;
}

TEST(BackSurface, DerivativeIsThatOfTheImage) {
  Random random(1);
  const BackSurface surface = back(1.5);
  for (int i = 0; i < 100; ++i) {
    const View view = random_view(random, plain_camera(), 0.8);
    const Eigen::Matrix3d KR = K * view.R;
    const Eigen::Vector3d Kt = K * view.t_over_d;
    const Eigen::Vector2d ref(random.uniform(220.0, 420.0), random.uniform(90.0, 390.0));
    const auto image = [&](const Eigen::Vector2d& px) {
      return Eigen::Vector2d((KR * surface.point(K_inverse * px.homogeneous()) + Kt).hnormalized());
    };
    Eigen::Matrix2d differences;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = 1e-4 * Eigen::Vector2d::Unit(axis);
      differences.col(axis) = (image(ref + step) - image(ref - step)) / 2e-4;
    }
    EXPECT_LT(
        (heel::image_derivative(surface, K_inverse, KR, Kt, K_inverse * ref.homogeneous()) - differences)
            .norm(),
        1e-6);
  }
}

TEST(CurvedBack, ExactWithoutNoiseFromEitherMinimum) {
  for (const double curvature : {0.0, 0.5, 1.5, 3.0}) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      Random random(seed);
      const View view = random_view(random, plain_camera(), 1.0);
      const std::vector<PointPair> pairs = pairs_on(back(curvature), random, view, 40, 0.0);
      FrontalPoseEstimator estimator(pairs.size());
      for (const PlaneMotion& start : {motion_of(view), mirrored(view)}) {
        const FrontalPose pose = estimator.estimate(problem_of(pairs, view, back(curvature)), start);
        EXPECT_LT((pose.motion.R_cur_from_ref - view.R).norm(), 1e-5)
            << "curvature " << curvature << ", seed " << seed;
        EXPECT_LT((pose.motion.t_over_d - view.t_over_d).norm(), 1e-5)
            << "curvature " << curvature << ", seed " << seed;
      }
    }
  }
}

// Of a back turned by 40° one half may be all that is matched. To a plane it is turned as that half is; and a
// curvature that is not quite the person's still serves far better than none.
TEST(CurvedBack, IsSeenAsTurnedAsItIs) {
  double plane_deg = 0.0, curved_deg = 0.0, wrong_curvature_deg = 0.0;
  constexpr int kTrials = 100;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed);
    const View view = view_at(0.7, 1.3);
    std::vector<PointPair> pairs = pairs_on(back(1.5), random, view, 160, 0.5);
    std::erase_if(pairs, [](const PointPair& pair) { return pair.ref_px.x() < kCentrePx.x(); });
    FrontalPoseEstimator estimator(pairs.size());
    const auto error_deg = [&](double assumed_curvature) {
      const FrontalPose pose =
          estimator.estimate(problem_of(pairs, view, back(assumed_curvature)), motion_of(view));
      return (pose.yaw_rad - 0.7) * 180.0 / M_PI / kTrials;
    };
    plane_deg += error_deg(0.0);
    curved_deg += error_deg(1.5);
    wrong_curvature_deg += error_deg(1.2);
  }
  std::cout << "mean yaw error at 40 deg: as a plane " << plane_deg << ", as curved " << curved_deg
            << ", as four fifths as curved " << wrong_curvature_deg << " deg\n";
  EXPECT_GT(std::abs(plane_deg), 8.0);
  EXPECT_NEAR(curved_deg, 0.0, 0.2);
  EXPECT_LT(std::abs(wrong_curvature_deg), 0.35 * std::abs(plane_deg));
}

// No back stays the curve. The departures are drawn as they are taken to be; the deviations that are stated
// know of them, from anywhere and from where the template was taken.
TEST(CurvedBack, StatedSigmaIsHonestWithFolds) {
  constexpr int kTrials = 1600;
  const BackSurface surface = back(1.5, 0.005);
  double yaw = 0.0, noise_only = 0.0;
  int within_1 = 0, within_2 = 0, within_3 = 0;
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed);
    const View view = seed % 2 == 0 ? random_view(random, plain_camera(), 0.9) : view_at(0.0, 1.0);
    const heel::Vector5d departures = drawn_departures(random);
    const std::vector<PointPair> pairs = pairs_on(surface, random, view, 60, 0.5, departures);
    FrontalPoseEstimator estimator(pairs.size());
    const FrontalPose pose = estimator.estimate(problem_of(pairs, view, surface), motion_of(view));
    const FrontalPose unaware = estimator.estimate(problem_of(pairs, view, back(1.5)), motion_of(view));
    const double error = pose.yaw_rad - heel::yaw_of_rotation(view.R);
    yaw += std::pow(error / pose.yaw_sigma_rad, 2) / kTrials;
    noise_only += std::pow(error / unaware.yaw_sigma_rad, 2) / kTrials;
    within_1 += std::abs(error) < pose.yaw_sigma_rad;
    within_2 += std::abs(error) < 2.0 * pose.yaw_sigma_rad;
    within_3 += std::abs(error) < 3.0 * pose.yaw_sigma_rad;
    t += (pose.motion.t_over_d - view.t_over_d).cwiseQuotient(pose.t_over_d_sigma).array().square().matrix() /
         kTrials;
  }
  std::cout << "normalised error squared: yaw " << yaw << " (by noise alone " << noise_only << "), t "
            << t.transpose() << "; within 1, 2, 3 sigma: " << within_1 << ", " << within_2 << ", " << within_3
            << " of " << kTrials << "\n";
  const double band = 1.96 * std::sqrt(2.0 / kTrials) + 0.05;
  EXPECT_NEAR(yaw, 1.0, band);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(t(i), 1.0, band) << "axis " << i;
  EXPECT_GT(noise_only, 2.0);
  EXPECT_NEAR(within_1, 0.683 * kTrials, 0.05 * kTrials);
  EXPECT_GT(within_3, 0.985 * kTrials);
}

// Where a plane's two minima are hardly to be told apart (three times the template's distance, nearly
// frontal), a curved back's are.
TEST(CurvedBack, IsRarelyMirrored) {
  constexpr int kTrials = 600;
  int flipped_plane = 0, flipped_curved = 0;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed);
    const double magnitude = random.uniform(0.1, 0.25);
    const View view = view_at(seed % 2 == 0 ? magnitude : -magnitude, 3.0);
    for (const double curvature : {0.0, 1.5}) {
      const std::vector<PointPair> pairs = pairs_on(back(curvature), random, view, 40, 0.8);
      FrontalPoseEstimator estimator(pairs.size());
      const FrontalPose pose = estimator.estimate(problem_of(pairs, view, back(curvature)), mirrored(view));
      (curvature > 0.0 ? flipped_curved : flipped_plane) +=
          pose.yaw_rad * heel::yaw_of_rotation(view.R) < 0.0;
    }
  }
  std::cout << "mirrored: " << flipped_plane << " of " << kTrials << " planes, " << flipped_curved
            << " curved backs\n";
  EXPECT_GT(flipped_plane, 5);  // the case is as hard as it is meant to be
  EXPECT_LT(flipped_curved, flipped_plane / 5 + 1);
}

TEST(CurvedBack, TooLittleToGoByMakesLargeDeviationsNotNonsense) {
  Random random(4);
  const View view = view_at(0.3, 1.5);
  FrontalPoseEstimator estimator(40);
  const auto all_finite = [](const FrontalPose& pose) {
    return std::isfinite(pose.yaw_rad) && std::isfinite(pose.yaw_sigma_rad) &&
           pose.t_over_d_sigma.allFinite() && pose.covariance.allFinite();
  };
  std::vector<PointPair> pairs = pairs_on(back(1.5), random, view, 40, 0.5);
  const double usual_rad =
      estimator.estimate(problem_of(pairs, view, back(1.5)), motion_of(view)).yaw_sigma_rad;
  for (const std::size_t few : {0u, 1u, 2u, 3u}) {
    const std::vector<PointPair> some(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(few));
    EXPECT_TRUE(all_finite(estimator.estimate(problem_of(some, view, back(1.5)), motion_of(view)))) << few;
  }
  // All on a vertical line: a back may turn about it as it likes.
  for (PointPair& pair : pairs) {
    pair.ref_px.x() = 330.0;
    const Eigen::Vector3d point = back(1.5).point(K_inverse * pair.ref_px.homogeneous());
    pair.cur_px = (K * (view.R * point + view.t_over_d)).hnormalized() + random.normal2(0.5);
  }
  const FrontalPose pose = estimator.estimate(problem_of(pairs, view, back(1.5)), motion_of(view));
  EXPECT_TRUE(all_finite(pose));
  EXPECT_GT(pose.yaw_sigma_rad, 5.0 * usual_rad);
}

/// A back with a feature of its own looks at each of many places, and a frame that shows it among clutter.
struct FeaturedBack {
  static constexpr int kFeatures = 200, kClutter = 400;
  heel::FeatureSet reference, frame;
  std::vector<Eigen::Vector2d> reference_px, frame_px;
  std::vector<PointPair> facet;  // what a homography takes: the middle third

  static heel::Descriptor random_descriptor(Random& random) {
    Eigen::Matrix<float, 64, 1> values;
    for (int i = 0; i < 64; ++i) values(i) = static_cast<float>(random.normal(1.0));
    values.normalize();
    heel::Descriptor descriptor{};
    std::copy(values.begin(), values.end(), descriptor.begin());
    return descriptor;
  }
  static void add(heel::FeatureSet& set, std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& px,
                  double sigma_px, const heel::Descriptor& descriptor) {
    heel::Feature feature;
    feature.x_px = static_cast<float>(px.x());
    feature.y_px = static_cast<float>(px.y());
    feature.sigma_px = static_cast<float>(sigma_px);
    feature.laplacian = 1;
    set.features.push_back(feature);
    set.descriptors.push_back(descriptor);
    points.push_back(px);
  }

  FeaturedBack(Random& random, const View& view, const BackSurface& surface) {
    for (const PointPair& pair : pairs_on(surface, random, view, kFeatures, 0.4)) {
      const heel::Descriptor descriptor = random_descriptor(random);
      const Eigen::Vector3d ray = K_inverse * pair.ref_px.homogeneous();
      const double area =
          heel::image_derivative(surface, K_inverse, K * view.R, K * view.t_over_d, ray).determinant();
      add(reference, reference_px, pair.ref_px, 3.0, descriptor);
      add(frame, frame_px, pair.cur_px, 3.0 * std::sqrt(std::max(area, 0.01)), descriptor);
      if (std::abs(pair.ref_px.x() - kCentrePx.x()) < 33.0) facet.push_back(pair);
    }
    for (int i = 0; i < kClutter; ++i)
      add(frame, frame_px, {random.uniform(0.0, 640.0), random.uniform(0.0, 480.0)}, 4.0,
          random_descriptor(random));
  }
};

TEST(SurfaceFollower, FindsTheWholeBackFromOneFacetAndEitherMinimum) {
  const BackSurface surface = back(1.5);
  double of_facet_deg = 0.0, of_back_deg = 0.0;
  constexpr int kTrials = 60;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed);
    const View view = view_at(random.uniform(-0.8, 0.8), random.uniform(0.8, 1.8));
    FeaturedBack shown(random, view, surface);
    FrontalPoseEstimator estimator(shown.reference_px.size());
    heel::GuidedMatcher matcher(FeaturedBack::kFeatures + FeaturedBack::kClutter, {});
    matcher.look_at(shown.frame, shown.frame_px);
    heel::SurfaceFollower follower({shown.reference, shown.reference_px, K_inverse}, estimator);
    const FrontalProblem problem = problem_of(shown.facet, view, surface);
    const FrontalPose start = estimator.estimate(problem, motion_of(view));
    FrontalPose swapped = start;
    std::swap(swapped.motion, swapped.other);
    const double truth = heel::yaw_of_rotation(view.R);
    of_facet_deg += std::abs(start.yaw_rad - truth) * 180.0 / M_PI / kTrials;
    for (const FrontalPose& from : {start, swapped}) {
      const FrontalPose pose = follower.follow(problem, from, matcher, shown.frame_px);
      EXPECT_NEAR(pose.yaw_rad, truth, 0.03) << "seed " << seed;
      of_back_deg += std::abs(pose.yaw_rad - truth) * 180.0 / M_PI / (2 * kTrials);
    }
  }
  std::cout << "mean |yaw error| of the facet " << of_facet_deg << " deg, of the back " << of_back_deg
            << " deg\n";
  EXPECT_LT(of_back_deg, 0.5 * of_facet_deg);
}

// Few features are seen again, and a strip of the back alone: the start is as wrong as noise makes it, both
// its minima with it. What fits of the rest of the back still tells.
TEST(SurfaceFollower, TriesTheWholeRangeOfYawWhereLittleFits) {
  const BackSurface surface = back(1.5);
  int wrong_start = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const View view = view_at(random.uniform(-0.8, 0.8), 1.3);
    FeaturedBack shown(random, view, surface);
    // Three of four frame features look like nothing known.
    for (std::size_t i = 0; i < FeaturedBack::kFeatures; ++i)
      if (i % 4 != 0) shown.frame.descriptors[i] = FeaturedBack::random_descriptor(random);
    FrontalPoseEstimator estimator(shown.reference_px.size());
    heel::GuidedMatcher matcher(FeaturedBack::kFeatures + FeaturedBack::kClutter, {});
    matcher.look_at(shown.frame, shown.frame_px);
    heel::SurfaceFollower follower({shown.reference, shown.reference_px, K_inverse}, estimator);

    // Both minima turned away from the truth about the strip in the middle.
    FrontalPose start = estimator.estimate(problem_of(shown.facet, view, surface), motion_of(view));
    const Eigen::Vector3d middle(0.0, 0.0, 1.0);
    for (heel::FrontalMotion* motion : {&start.motion, &start.other}) {
      const Eigen::Matrix3d R =
          Eigen::AngleAxisd(view.R.col(2).x() > 0.0 ? -1.2 : 1.2, Eigen::Vector3d::UnitY())
              .toRotationMatrix() *
          view.R;
      motion->t_over_d = view.t_over_d + (view.R - R) * middle;
      motion->R_cur_from_ref = R;
    }
    const double truth = heel::yaw_of_rotation(view.R);
    wrong_start += std::abs(heel::yaw_of_rotation(start.motion.R_cur_from_ref) - truth) > 1.0;
    const FrontalPose pose =
        follower.follow(problem_of(shown.facet, view, surface), start, matcher, shown.frame_px);
    EXPECT_NEAR(pose.yaw_rad, truth, 0.06) << "seed " << seed;
    EXPECT_GT(follower.pairs(), 35U) << "seed " << seed;
  }
  EXPECT_EQ(wrong_start, 40);
}

TEST(SurfaceFollower, KeepsItsStartWhereNothingFits) {
  Random random(8);
  const View view = view_at(0.2, 1.5);
  const FeaturedBack shown(random, view, back(1.5));
  FrontalPoseEstimator estimator(shown.reference_px.size());
  heel::GuidedMatcher matcher(10, {});
  const heel::FeatureSet nothing;
  matcher.look_at(nothing, {});
  heel::SurfaceFollower follower({shown.reference, shown.reference_px, K_inverse}, estimator);
  const FrontalProblem problem = problem_of(shown.facet, view, back(1.5));
  const FrontalPose start = estimator.estimate(problem, motion_of(view));
  EXPECT_EQ(follower.follow(problem, start, matcher, {}).yaw_rad, start.yaw_rad);
}

TEST(SurfaceFollower, AllocatesNothing) {
  if (!heel::test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  Random random(9);
  const View view = view_at(0.5, 1.3);
  const FeaturedBack shown(random, view, back(1.5));
  FrontalPoseEstimator estimator(shown.reference_px.size());
  heel::GuidedMatcher matcher(FeaturedBack::kFeatures + FeaturedBack::kClutter, {});
  matcher.look_at(shown.frame, shown.frame_px);
  heel::SurfaceFollower follower({shown.reference, shown.reference_px, K_inverse}, estimator);
  const FrontalProblem problem = problem_of(shown.facet, view, back(1.5, 0.005));
  const std::uint64_t before = heel::test::allocations_of_this_thread();
  const FrontalPose start = estimator.estimate(problem, motion_of(view));
  const FrontalPose pose = follower.follow(problem, start, matcher, shown.frame_px);
  EXPECT_EQ(heel::test::allocations_of_this_thread() - before, 0u);
  EXPECT_NEAR(pose.yaw_rad, 0.5, 0.03);
}

}  // namespace
