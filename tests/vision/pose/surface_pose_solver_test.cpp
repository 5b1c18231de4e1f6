// The pose of a known surface from observed places: exact, robust, with a sigma that includes the cloth.
#include "vision/pose/surface_pose_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "support/allocation_count.h"
#include "vision/pose/curved_back.h"

namespace heel {
namespace {

using namespace test::curved;
using test::plain_camera;
using test::Random;
using test::random_view;
using test::View;

BackSurface shaped_back(double shape_sigma_m) {
  BackSurface surface = test::curved::back(0.0, shape_sigma_m);
  const double per_d = 1.0 / kDistance_m;
  surface.depth = {.u2 = -0.013 * per_d,
                   .u4 = 0.049 * per_d,
                   .v = -0.01 * per_d,
                   .v2 = -0.011 * per_d,
                   .v3 = -0.006 * per_d,
                   .u2v = 0.013 * per_d};
  return surface;
}

FrontalMotion true_motion(const View& view) {
  FrontalMotion motion;
  motion.R_cur_from_ref = view.R;
  motion.t_over_d = view.t_over_d;
  return motion;
}

FrontalMotion start_off(const View& view, double turn_rad) {
  FrontalMotion motion = true_motion(view);
  motion.R_cur_from_ref = test::rotation(turn_rad, 0.05, 0.02) * view.R;
  motion.t_over_d +=
      (view.R - motion.R_cur_from_ref) * Eigen::Vector3d::UnitZ() + Eigen::Vector3d(0.02, -0.02, 0.05);
  return motion;
}

/// How far cloth and body lie from the surface at a place, as SurfacePoseSolver describes it, but drawn.
struct Departures {
  Eigen::Matrix<double, 17, 1> a = Eigen::Matrix<double, 17, 1>::Zero();

  static Departures drawn(Random& random) {
    Departures departures;
    for (Eigen::Index i = 0; i < departures.a.size(); ++i) departures.a(i) = random.normal(1.0);
    return departures;
  }
  Eigen::Vector3d at(const BackSurface& surface, const Eigen::Vector3d& ray) const {
    const double u = surface.u(ray), v = surface.v(ray);
    const double uu = u * u - 1.0 / 3.0, vv = v * v - 1.0 / 3.0, uv = u * v, uuu = u * u * u - 0.6 * u;
    const double normal = surface.shape_sigma, along = 0.75 * normal;
    const double body = surface.bend_sigma * surface.half_size.x() * surface.half_size.x();
    const Eigen::Vector3d moved(
        along * (0.5 * a(0) * u + a(1) * uu + a(2) * uv + a(3) * vv),
        along * (a(4) * uu + a(5) * vv) + 0.75 * normal * a(6) * uv + 0.2 * normal * a(7) * v,
        normal * (a(8) * u + a(9) * v + a(10) * uu + a(11) * uv + a(12) * vv));
    return moved + body * (a(13) * u + a(14) * uu + a(15) * uv + a(16) * uuu) * ray;
  }
};

std::vector<SurfaceObservation> observations_of(const BackSurface& surface, Random& random, const View& view,
                                                int count, double noise_px, const Departures& departures = {},
                                                double patch_sigma = 0.0) {
  std::vector<SurfaceObservation> observations;
  const Eigen::Matrix3d KR = K * view.R;
  const Eigen::Vector3d Kt = K * view.t_over_d;
  while (static_cast<int>(observations.size()) < count) {
    const Eigen::Vector2d ref_px(random.uniform(220.0, 420.0), random.uniform(90.0, 390.0));
    const Eigen::Vector3d ray = K_inverse * ref_px.homogeneous();
    if (heel::image_derivative(surface, K_inverse, KR, Kt, ray).determinant() <= 0.0) continue;
    const Eigen::Vector3d pixel = KR * (surface.point(ray) + departures.at(surface, ray)) + Kt;
    const double cloth_px = patch_sigma * K(0, 0) / pixel.z();
    observations.push_back({ray, pixel.hnormalized() + random.normal2(noise_px) + random.normal2(cloth_px),
                            noise_px * noise_px * Eigen::Matrix2d::Identity()});
  }
  return observations;
}

double yaw_error(const FrontalMotion& motion, const View& view) {
  return heel::yaw_of_rotation(motion.R_cur_from_ref) - heel::yaw_of_rotation(view.R);
}

TEST(SurfacePoseSolver, IsExactWithoutNoise) {
  const BackSurface surface = shaped_back(0.004);
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    const View view = random_view(random, plain_camera(), 0.9);
    std::vector<SurfaceObservation> observations = observations_of(surface, random, view, 60, 0.0);
    SurfacePoseSolver solver(K, observations.size());
    const FrontalMotion motion = solver.solve(surface, observations, start_off(view, 0.15), 20);
    EXPECT_LT((motion.R_cur_from_ref - view.R).norm(), 1e-4) << "seed " << seed;
    EXPECT_LT((motion.t_over_d - view.t_over_d).norm(), 1e-4) << "seed " << seed;
    for (std::size_t i = 0; i < observations.size(); ++i) EXPECT_LT(solver.cost(i), 1e-3) << "seed " << seed;
  }
}

TEST(SurfacePoseSolver, IgnoresObservationsThatAreFarOff) {
  const BackSurface surface = shaped_back(0.004);
  double worst_rad = 0.0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    const View view = random_view(random, plain_camera(), 0.7);
    std::vector<SurfaceObservation> observations = observations_of(surface, random, view, 100, 0.3);
    for (std::size_t i = 0; i < 20; ++i)
      observations[i].cur_px += Eigen::Vector2d(random.uniform(10.0, 40.0), -15.0);
    SurfacePoseSolver solver(K, observations.size());
    const FrontalMotion motion = solver.solve(surface, observations, start_off(view, 0.05), 20);
    worst_rad = std::max(worst_rad, std::abs(yaw_error(motion, view)));
    for (std::size_t i = 0; i < 20; ++i) EXPECT_LT(solver.weight(i), 0.3) << "seed " << seed;
    int fit = 0;
    for (std::size_t i = 20; i < observations.size(); ++i) fit += solver.weight(i) > 0.3;
    EXPECT_GT(fit, 72) << "seed " << seed;
  }
  EXPECT_LT(worst_rad, 0.06);
}

// A side that hangs lower than when it was taught is no turn.
TEST(SurfacePoseSolver, TakesAKeystoneForClothNotForATurn) {
  double as_cloth_rad = 0.0, as_turn_rad = 0.0;
  constexpr int kTrials = 40;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed);
    const View view = view_at(random.uniform(-0.6, 0.6), 1.3);
    Departures keystone;
    keystone.a(6) = 1.5;
    const std::vector<SurfaceObservation> observations =
        observations_of(shaped_back(0.004), random, view, 150, 0.2, keystone);
    SurfacePoseSolver solver(K, observations.size());
    as_cloth_rad +=
        std::abs(yaw_error(solver.solve(shaped_back(0.004), observations, true_motion(view), 20), view));
    as_turn_rad +=
        std::abs(yaw_error(solver.solve(shaped_back(0.0), observations, true_motion(view), 20), view));
  }
  std::cout << "mean |yaw error| of a keystone: as cloth " << as_cloth_rad / kTrials << " rad, as a turn "
            << as_turn_rad / kTrials << " rad\n";
  EXPECT_LT(as_cloth_rad, 0.7 * as_turn_rad);
  EXPECT_GT(as_turn_rad / kTrials, 0.01);
}

TEST(SurfacePoseSolver, StatedSigmaIncludesClothAndBody) {
  constexpr int kTrials = 600;
  BackSurface surface = shaped_back(0.004);
  surface.bend_sigma = 0.33 * kDistance_m;
  double yaw = 0.0;
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  int within_1 = 0, within_3 = 0;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed);
    const View view = random_view(random, plain_camera(), 0.8);
    const std::vector<SurfaceObservation> observations = observations_of(
        surface, random, view, 120, 0.3, Departures::drawn(random), 0.75 * surface.shape_sigma);
    SurfacePoseSolver solver(K, observations.size());
    const FrontalMotion motion = solver.solve(surface, observations, true_motion(view), 20);
    const heel::Matrix6d covariance = solver.covariance();
    const double error = yaw_error(motion, view),
                 sigma = heel::yaw_sigma_rad(motion.R_cur_from_ref, covariance);
    yaw += error * error / (sigma * sigma) / kTrials;
    within_1 += std::abs(error) < sigma;
    within_3 += std::abs(error) < 3.0 * sigma;
    t += (motion.t_over_d - view.t_over_d).cwiseAbs2().cwiseQuotient(covariance.diagonal().tail<3>()) /
         kTrials;
  }
  std::cout << "normalised error squared: yaw " << yaw << ", t " << t.transpose() << "; within 1 sigma "
            << within_1 << ", 3 sigma " << within_3 << " of " << kTrials << "\n";
  // Robust weights take part of a large departure for outliers, which the covariance does not include.
  EXPECT_NEAR(yaw, 1.1, 0.25);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(t(i), 1.1, 0.25) << "axis " << i;
  EXPECT_NEAR(within_1, 0.683 * kTrials, 0.06 * kTrials);
  EXPECT_GT(within_3, 0.985 * kTrials);
}

TEST(SurfacePoseSolver, APriorKeepsWhatFewObservationsLeaveOpen) {
  const BackSurface surface = shaped_back(0.004);
  Random random(3);
  const View view = view_at(0.3, 1.3);
  const std::vector<SurfaceObservation> three = observations_of(surface, random, view, 3, 0.5);
  SurfacePoseSolver solver(K, 3);
  const MotionPrior tight{Eigen::Vector3d::Constant(0.01), Eigen::Vector3d::Constant(0.01)};
  const FrontalMotion kept = solver.solve(surface, three, true_motion(view), 10, tight);
  EXPECT_LT(std::abs(yaw_error(kept, view)), 0.01);
  EXPECT_TRUE(kept.t_over_d.allFinite());
}

TEST(SurfacePoseSolver, AllocatesNothingAndIgnoresWhatIsTooMuch) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const BackSurface surface = shaped_back(0.004);
  Random random(5);
  const View view = view_at(0.2, 1.2);
  const std::vector<SurfaceObservation> observations = observations_of(surface, random, view, 80, 0.2);
  SurfacePoseSolver solver(K, 50);
  const std::uint64_t before = test::allocations_of_this_thread();
  const FrontalMotion motion = solver.solve(surface, observations, true_motion(view), 8);
  solver.covariance();
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u);
  const FrontalMotion of_first_50 =
      SurfacePoseSolver(K, 50).solve(surface, std::span(observations).first(50), true_motion(view), 8);
  EXPECT_EQ(motion.t_over_d, of_first_50.t_over_d);
}

}  // namespace
}  // namespace heel
