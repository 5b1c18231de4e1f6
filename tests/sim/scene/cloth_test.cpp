// The folds of a shirt: how high, over which length they are alike, how they follow the gait; and the rigid
// fit that says how the back is turned in spite of them.
#include "sim/scene/cloth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/random.h"
#include "sim/scene/back_shape.h"
#include "sim/scene/person.h"
#include "sim/scene/rigid_fit.h"

namespace heel::sim {
namespace {

const ClothGrid kGrid{{-0.1, 0.0, 0.07}, {0.4, 0.3}};
constexpr int kShirts = 60;

ClothState folded(std::uint64_t settling) {
  ClothState state;
  state.settling = settling;
  state.fold_m = 0.010;
  return state;
}

/// Correlation of the folds of many shirts between two states, and `apart_m` around the body.
double correlation(const ClothState& a, const ClothState& b, double apart_m) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::uint64_t shirt = 0; shirt < kShirts; ++shirt) {
    const Cloth cloth(shirt, kGrid);
    const Cloth::Shifts first(cloth, a), second(cloth, b);
    for (double z_m = 0.1; z_m < 0.5; z_m += 0.1) {
      const double x = first.at(-0.5 * apart_m, z_m).normal_m, y = second.at(0.5 * apart_m, z_m).normal_m;
      ab += x * y;
      aa += x * x;
      bb += y * y;
    }
  }
  return ab / std::sqrt(aa * bb);
}

TEST(Cloth, FoldsHaveTheirStatedHeight) {
  double sum2 = 0.0;
  int count = 0;
  for (std::uint64_t shirt = 0; shirt < kShirts; ++shirt) {
    const Cloth cloth(shirt, kGrid);
    const Cloth::Shifts shifts(cloth, folded(shirt));
    for (double s_m = -0.15; s_m < 0.16; s_m += 0.05, ++count)
      sum2 += std::pow(shifts.at(s_m, 0.3).normal_m, 2);
  }
  EXPECT_NEAR(std::sqrt(sum2 / count), 0.010, 0.0015);
}

TEST(Cloth, FoldsAreAlikeOverAFewCentimetres) {
  EXPECT_GT(correlation(folded(1), folded(1), 0.02), 0.9);
  const double some = correlation(folded(1), folded(1), 0.08);
  EXPECT_GT(some, 0.3);
  EXPECT_LT(some, 0.85);
  EXPECT_LT(std::abs(correlation(folded(1), folded(1), 0.35)), 0.25);
}

TEST(Cloth, SettlesEachTimeInAnotherWay) {
  EXPECT_NEAR(correlation(folded(1), folded(1), 0.0), 1.0, 1e-6);
  EXPECT_LT(std::abs(correlation(folded(1), folded(2), 0.0)), 0.25);
}

TEST(Cloth, FollowsTheGait) {
  // A stride of two steps takes about 1.16 s.
  const auto after = [](double t_s) {
    ClothState state = folded(1);
    state.stride_rad = 2.0 * M_PI * t_s / 1.16;
    return correlation(folded(1), state, 0.0);
  };
  EXPECT_NEAR(after(0.067), 0.75, 0.2);
  EXPECT_LT(after(0.2), 0.45);
  const double stride_later = after(1.16);
  EXPECT_GT(stride_later, 0.35);
  EXPECT_LT(stride_later, 0.9);
}

TEST(Cloth, SlopesAreThoseOfTheFoldsAndRowsThoseOfPlaces) {
  const Cloth cloth(3, kGrid);
  ClothState state = folded(4);
  state.drag_m = 0.003;
  state.stride_rad = 1.7;
  const Cloth::Shifts shifts(cloth, state);
  constexpr double kStep_m = 1e-3;
  const auto normal_m = [&](double s_m, double z_m) {
    return static_cast<double>(shifts.at(s_m, z_m).normal_m);
  };
  const ClothShift here = shifts.at(0.05, 0.3);
  EXPECT_NEAR(here.slope_around,
              (normal_m(0.05 + kStep_m, 0.3) - normal_m(0.05 - kStep_m, 0.3)) / (2 * kStep_m), 2e-3);
  EXPECT_NEAR(here.slope_up, (normal_m(0.05, 0.3 + kStep_m) - normal_m(0.05, 0.3 - kStep_m)) / (2 * kStep_m),
              2e-3);
  std::vector<ClothShift> row;
  for (std::size_t k = 0; k < kGrid.z_m.size(); ++k) {
    shifts.row(k, row);
    ASSERT_EQ(row.size(), kGrid.s_m.size());
    for (std::size_t j = 0; j < row.size(); ++j) {
      const ClothShift place = shifts.at(kGrid.s_m[j], kGrid.z_m[k]);
      EXPECT_NEAR(row[j].normal_m, place.normal_m, 1e-6);
      EXPECT_NEAR(row[j].around_m, place.around_m, 1e-6);
      EXPECT_NEAR(row[j].up_m, place.up_m, 1e-6);
      EXPECT_NEAR(row[j].slope_around, place.slope_around, 1e-5);
      EXPECT_NEAR(row[j].slope_up, place.slope_up, 1e-5);
    }
  }
}

TEST(BackShape, FallsAtTheSidesAndComesNearerAtTheWaist) {
  double side_mm = 0.0, waist_mm = 0.0;
  constexpr int kPeople = 40;
  for (std::uint64_t seed = 0; seed < kPeople; ++seed) {
    const BackShape back(1.0, seed);
    double middle = 0.0;
    for (int i = -6; i <= 6; ++i) middle += back.depth_m(0.1 * i, 0.0) / 13;
    const double side = 0.5 * (back.depth_m(1.0, 0.0) + back.depth_m(-1.0, 0.0)) - middle;
    EXPECT_GT(side, 0.010);
    EXPECT_LT(side, 0.065);
    side_mm += 1e3 * side / kPeople;
    waist_mm += 1e3 * (back.depth_m(0.0, 1.0) - back.depth_m(0.0, 0.0)) / kPeople;
    // The valley of the spine lies deeper than the shoulder blades.
    EXPECT_GT(back.depth_m(0.0, -0.5), 0.5 * (back.depth_m(0.5, -0.5) + back.depth_m(-0.5, -0.5)));
  }
  EXPECT_NEAR(side_mm, 35.9, 6.0);    // −13.3 + 49.2
  EXPECT_NEAR(waist_mm, -27.4, 6.0);  // −10.2 − 11.1 − 6.1
}

TEST(BackShape, ADeepBodyFallsFurtherAtTheSides) {
  EXPECT_GT(BackShape(1.3, 5).depth_m(1.0, 0.0), BackShape(0.75, 5).depth_m(1.0, 0.0) + 0.01);
}

TEST(RigidFit, FindsTheMotionThroughNoise) {
  Random random(1);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.1, 0.9, -0.2).normalized()).toRotationMatrix();
  const Eigen::Vector3d t(0.3, -1.0, 2.0);
  std::vector<Eigen::Vector3d> from, exact, noisy;
  for (int i = 0; i < 100; ++i) {
    from.emplace_back(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.03, 0.03));
    exact.push_back(R * from.back() + t);
    noisy.push_back(exact.back() +
                    0.002 * Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
  }
  EXPECT_TRUE(fit_rigid(from, exact).R.isApprox(R, 1e-12));
  EXPECT_LT((fit_rigid(from, exact).t_m - t).norm(), 1e-12);
  EXPECT_LT(Eigen::AngleAxisd(fit_rigid(from, noisy).R.transpose() * R).angle(), 0.01);
}

TEST(Torso, ABoardIsFlatAndItsClothDoesNotMove) {
  const Torso board(TorsoShape::Board, 1.0, 7);
  ClothState state = folded(3);
  state.twist_rad = 0.1;
  const Mesh still = board.at_rest(), moved = board.mesh(state);
  for (std::size_t i = 0; i < still.vertices.size(); ++i) {
    EXPECT_EQ(moved.vertices[i].position_m, still.vertices[i].position_m);
    EXPECT_EQ(moved.vertices[i].position_m.x(), still.vertices.front().position_m.x());
  }
}

TEST(Torso, ATwistTurnsTheHemAndNotTheShoulders) {
  const Torso torso(TorsoShape::Body, 1.0, 7);
  ClothState state;
  state.twist_rad = 0.2;
  const auto turned_rad = [&](double t_texel) {
    const Eigen::Vector3d before = torso.shirt_point_m(512, t_texel, {}),
                          after = torso.shirt_point_m(512, t_texel, state);
    return std::atan2(before.x() * after.y() - before.y() * after.x(), before.head<2>().dot(after.head<2>()));
  };
  EXPECT_NEAR(turned_rad(120), 0.0, 1e-6);
  EXPECT_GT(turned_rad(400), 0.05);
  EXPECT_NEAR(turned_rad(690), 0.2, 0.01);
}

}  // namespace
}  // namespace heel::sim
