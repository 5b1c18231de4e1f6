// The pose of the whole back from one facet of it, and its sigma where other poses fit as well.
#include "vision/pose/curved_surface_refiner.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "support/allocation_count.h"
#include "vision/pose/alternative_hypotheses.h"
#include "vision/pose/curved_back.h"

namespace heel {
namespace {

using namespace test::curved;
using test::Random;
using test::View;

/// A back with features of unique descriptors, and a frame that shows it among clutter.
struct FeaturedBack {
  static constexpr int kFeatures = 200, kClutter = 400;
  FeatureSet reference, frame;
  std::vector<Eigen::Vector2d> reference_px, frame_px;
  std::vector<PointPair> facet;  // the pairs that agree on one plane: the middle third

  static Descriptor random_descriptor(Random& random) {
    Eigen::Matrix<float, 64, 1> values;
    for (int i = 0; i < 64; ++i) values(i) = static_cast<float>(random.normal(1.0));
    values.normalize();
    Descriptor descriptor{};
    std::copy(values.begin(), values.end(), descriptor.begin());
    return descriptor;
  }
  static void add(FeatureSet& set, std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& px,
                  double sigma_px, const Descriptor& descriptor) {
    Feature feature;
    feature.x_px = static_cast<float>(px.x());
    feature.y_px = static_cast<float>(px.y());
    feature.sigma_px = static_cast<float>(sigma_px);
    feature.laplacian = 1;
    set.features.push_back(feature);
    set.descriptors.push_back(descriptor);
    points.push_back(px);
  }

  FeaturedBack(Random& random, const View& view, const BackSurface& surface,
               const Vector5d& departures = Vector5d::Zero()) {
    for (const PointPair& pair : pairs_on(surface, random, view, kFeatures, 0.4, departures)) {
      const Descriptor descriptor = random_descriptor(random);
      const Eigen::Vector3d ray = K_inverse * pair.ref_px.homogeneous();
      const double area =
          image_derivative(surface, K_inverse, K * view.R, K * view.t_over_d, ray).determinant();
      add(reference, reference_px, pair.ref_px, 3.0, descriptor);
      add(frame, frame_px, pair.cur_px, 3.0 * std::sqrt(std::max(area, 0.01)), descriptor);
      if (std::abs(pair.ref_px.x() - kCentre_px.x()) < 33.0) facet.push_back(pair);
    }
    for (int i = 0; i < kClutter; ++i)
      add(frame, frame_px, {random.uniform(0.0, 640.0), random.uniform(0.0, 480.0)}, 4.0,
          random_descriptor(random));
  }
};

/// A refiner for the template of `shown`, and what it needs of the frame.
class RefinerFor {
 public:
  explicit RefinerFor(const FeaturedBack& shown)
      : estimator(shown.reference_px.size()),
        shown_(shown),
        matcher_(shown.reference, kMaxFeatures, MatchSettings{}.ratio),
        grid_(kMaxFeatures, GuidedMatchSettings{}.radius_px),
        surface_matcher_(shown.reference_px, K_inverse, K),
        refiner_(shown.reference_px, K_inverse, estimator, surface_matcher_) {}

  CurvedSurfacePose refine(const FrontalProblem& problem, const FrontalPose& start) {
    return refine(problem, start, shown_.frame, shown_.frame_px);
  }
  CurvedSurfacePose refine(const FrontalProblem& problem, const FrontalPose& start, const FeatureSet& frame,
                           std::span<const Eigen::Vector2d> frame_px) {
    grid_.assign(frame, frame_px);
    return refiner_.refine(problem, start, matcher_, grid_);
  }

  FrontalPoseEstimator estimator;

 private:
  static constexpr int kMaxFeatures = FeaturedBack::kFeatures + FeaturedBack::kClutter;

  const FeaturedBack& shown_;
  TemplateMatcher matcher_;
  FeatureGrid grid_;
  SurfaceMatcher surface_matcher_;
  CurvedSurfaceRefiner refiner_;
};

TEST(CurvedSurfaceRefiner, FindsTheWholeBackFromOneFacetAndEitherMinimum) {
  const BackSurface surface = back(1.5);
  double of_facet_deg = 0.0, of_back_deg = 0.0;
  constexpr int kTrials = 60;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed);
    const View view = view_at(random.uniform(-0.8, 0.8), random.uniform(0.8, 1.8));
    FeaturedBack shown(random, view, surface);
    RefinerFor refiner(shown);
    const FrontalProblem problem = problem_of(shown.facet, view, surface);
    const FrontalPose start = refiner.estimator.estimate(problem, motion_of(view));
    FrontalPose swapped = start;
    std::swap(swapped.motion, swapped.other);
    const double truth = yaw_of_rotation(view.R);
    of_facet_deg += std::abs(start.yaw_rad - truth) * 180.0 / M_PI / kTrials;
    for (const FrontalPose& from : {start, swapped}) {
      const FrontalPose pose = refiner.refine(problem, from).pose;
      EXPECT_NEAR(pose.yaw_rad, truth, 0.03) << "seed " << seed;
      of_back_deg += std::abs(pose.yaw_rad - truth) * 180.0 / M_PI / (2 * kTrials);
    }
  }
  std::cout << "mean |yaw error| of the facet " << of_facet_deg << " deg, of the back " << of_back_deg
            << " deg\n";
  EXPECT_LT(of_back_deg, 0.5 * of_facet_deg);
}

// Few features are found again, and the start is based on a strip of the back only: both its minima are
// wrong. The rest of the back determines the yaw.
TEST(CurvedSurfaceRefiner, TriesTheWholeRangeOfYawWhereLittleFits) {
  const BackSurface surface = back(1.5);
  int wrong_start = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const View view = view_at(random.uniform(-0.8, 0.8), 1.3);
    FeaturedBack shown(random, view, surface);
    // Three of four frame features get unknown descriptors.
    for (std::size_t i = 0; i < FeaturedBack::kFeatures; ++i)
      if (i % 4 != 0) shown.frame.descriptors[i] = FeaturedBack::random_descriptor(random);
    RefinerFor refiner(shown);

    // Both minima are rotated away from the truth about the strip in the middle.
    FrontalPose start = refiner.estimator.estimate(problem_of(shown.facet, view, surface), motion_of(view));
    const Eigen::Vector3d middle(0.0, 0.0, 1.0);
    for (FrontalMotion* motion : {&start.motion, &start.other}) {
      const Eigen::Matrix3d R =
          Eigen::AngleAxisd(view.R.col(2).x() > 0.0 ? -1.2 : 1.2, Eigen::Vector3d::UnitY())
              .toRotationMatrix() *
          view.R;
      motion->t_over_d = view.t_over_d + (view.R - R) * middle;
      motion->R_cur_from_ref = R;
    }
    const double truth = yaw_of_rotation(view.R);
    wrong_start += std::abs(yaw_of_rotation(start.motion.R_cur_from_ref) - truth) > 1.0;
    const CurvedSurfacePose found = refiner.refine(problem_of(shown.facet, view, surface), start);
    EXPECT_NEAR(found.pose.yaw_rad, truth, 0.06) << "seed " << seed;
    EXPECT_GT(found.pairs.size(), 35U) << "seed " << seed;
  }
  EXPECT_EQ(wrong_start, 40);
}

TEST(CurvedSurfaceRefiner, KeepsItsStartWhereNothingFits) {
  Random random(8);
  const View view = view_at(0.2, 1.5);
  const FeaturedBack shown(random, view, back(1.5));
  RefinerFor refiner(shown);
  const FrontalProblem problem = problem_of(shown.facet, view, back(1.5));
  const FrontalPose start = refiner.estimator.estimate(problem, motion_of(view));
  const CurvedSurfacePose kept = refiner.refine(problem, start, FeatureSet{}, {});
  EXPECT_EQ(kept.pose.yaw_rad, start.yaw_rad);
  EXPECT_TRUE(kept.pairs.empty());
}

TEST(CurvedSurfaceRefiner, AllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  Random random(9);
  const View view = view_at(0.5, 1.3);
  FeaturedBack shown(random, view, back(1.5));
  RefinerFor refiner(shown);
  const FrontalProblem problem = problem_of(shown.facet, view, back(1.5, 0.005));
  for (const bool few : {false, true}) {
    // So few match that the whole range of yaw is tried.
    for (std::size_t i = 0; few && i < FeaturedBack::kFeatures; ++i)
      if (i % 4 != 0) shown.frame.descriptors[i] = FeaturedBack::random_descriptor(random);
    const std::uint64_t before = test::allocations_of_this_thread();
    const FrontalPose start = refiner.estimator.estimate(problem, motion_of(view));
    const FrontalPose pose = refiner.refine(problem, start).pose;
    EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
    EXPECT_NEAR(pose.yaw_rad, 0.5, 0.05);
  }
}

// The curvature differs from the assumed one, and folds have moved the points. The stated sigma covers the
// error, both if the whole back is visible and if only half of the features of a strip at its edge are found:
// then other yaws fit nearly as well.
TEST(CurvedSurfaceRefiner, StatedSigmaCoversWhatAStripOfTheBackLeavesOpen) {
  constexpr int kTrials = 300;
  BackSurface assumed = back(1.5, 0.002);
  assumed.bend_sigma = 0.35 * kDistance_m;  // of a curvature drawn uniformly from 0.9 to 2.1
  for (const bool whole : {true, false}) {
    int beyond_3 = 0, beyond_3_without = 0, doubted = 0;
    for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
      Random random(seed);
      const View view = view_at(random.uniform(-0.5, 0.5), random.uniform(1.2, 2.0));
      FeaturedBack shown(random, view, back(random.uniform(0.9, 2.1), 0.002), drawn_departures(random));
      std::vector<PointPair> seen;
      for (std::size_t i = 0; i < shown.reference_px.size(); ++i) {
        if (whole || (i % 2 == 0 && shown.reference_px[i].x() < kCentre_px.x() - 30.0)) {
          seen.push_back({shown.reference_px[i], shown.frame_px[i]});
        } else {
          shown.frame.descriptors[i] = FeaturedBack::random_descriptor(random);
        }
      }
      RefinerFor refiner(shown);
      const FrontalProblem problem = problem_of(seen, view, assumed);
      FrontalPose start = refiner.estimator.estimate(problem, motion_of(view));
      if (seed % 2 == 0) std::swap(start.motion, start.other);
      const FrontalPose pose = refiner.refine(problem, start).pose;
      const double error = std::abs(pose.yaw_rad - yaw_of_rotation(view.R));
      beyond_3 += error > 3.0 * pose.yaw_sigma_rad;
      beyond_3_without += error > 3.0 * std::sqrt(pose.covariance(1, 1));
      doubted += pose.ambiguity > 0.1;
    }
    std::cout << (whole ? "whole" : "strip") << ": beyond 3 sigma " << beyond_3 << " of " << kTrials
              << ", by the covariance alone " << beyond_3_without << "; doubted " << doubted << "\n";
    EXPECT_LE(beyond_3, kTrials / 50);
    if (whole) {
      EXPECT_LT(doubted, kTrials / 50);
    } else {
      EXPECT_GT(beyond_3_without, 2 * beyond_3 + 3);
    }
  }
}

TEST(AlternativeHypotheses, AddTheirExpectedSquaredError) {
  FrontalPose pose;
  pose.motion.R_cur_from_ref = test::rotation(0.3, 0.0, 0.0);
  pose.motion.t_over_d = {0.1, 0.0, 0.2};
  pose.yaw_rad = 0.3;
  pose.yaw_sigma_rad = 0.02;
  pose.t_over_d_sigma = {0.01, 0.02, 0.03};
  const FrontalPose alone = pose;
  inflate_covariance({}, pose);
  EXPECT_EQ(pose.yaw_sigma_rad, alone.yaw_sigma_rad);
  EXPECT_EQ(pose.ambiguity, 0.0);

  AlternativeHypothesis alternative;
  alternative.motion.R_cur_from_ref = test::rotation(-0.1, 0.0, 0.0);
  alternative.motion.t_over_d = {0.2, 0.0, 0.2};
  alternative.odds = 0.25;  // true one time in five
  inflate_covariance({&alternative, 1}, pose);
  EXPECT_NEAR(pose.ambiguity, 0.2, 1e-12);
  EXPECT_NEAR(pose.yaw_sigma_rad, std::sqrt(0.02 * 0.02 + 0.2 * 0.4 * 0.4), 1e-9);
  EXPECT_NEAR(pose.t_over_d_sigma.x(), std::sqrt(0.01 * 0.01 + 0.2 * 0.1 * 0.1), 1e-12);
  EXPECT_NEAR(pose.t_over_d_sigma.z(), 0.03, 1e-12);
  EXPECT_EQ(pose.yaw_rad, 0.3) << "the pose itself does not change";
}

TEST(AlternativeHypotheses, YawDifferenceIsTakenRoundTheCircle) {
  FrontalMotion a, b;
  a.R_cur_from_ref = test::rotation(3.0, 0.0, 0.0);
  b.R_cur_from_ref = test::rotation(-3.0, 0.0, 0.0);
  EXPECT_NEAR(yaw_difference_rad(a, b), 2.0 * M_PI - 6.0, 1e-12);
}

}  // namespace
}  // namespace heel
