// The error model: what is fitted to made-up rows is what they were made with, and poses come out as it says.
#include "sim/pose_noise/error_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/random.h"
#include "heel/error.h"
#include "sim/pose_noise/error_fit.h"
#include "sim/pose_noise/sampled_poses.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel::sim {
namespace {

using ::testing::HasSubstr;

constexpr double kTrueSlope = -0.3, kTrueRangeShare = -0.02, kTrueSigma_rad = 0.04;

double found_probability(const ViewConditions& c) {
  return 1.0 / (1.0 + std::exp(-(9.0 - 2.0 * c.distance_m)));
}

/// Yaw errs by −0.3 a³ with a spread of 0.01 per metre, the range by −2 %, and beyond 4.5 m little is found.
std::vector<FitRow> made_up_rows(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<FitRow> rows;
  for (int i = 0; i < count; ++i) {
    FitRow row;
    row.conditions.distance_m = random.uniform(1.0, 5.5);
    row.conditions.aspect_rad = random.uniform(-1.2, 1.2);
    row.world = static_cast<std::uint64_t>(i % 7);
    row.found = random.uniform() < found_probability(row.conditions);
    row.certainty = std::exp(-0.5 * row.conditions.distance_m);
    row.aspect_error_rad = kTrueSlope * std::pow(row.conditions.aspect_rad, 3) +
                           0.01 * row.conditions.distance_m * random.normal();
    row.range_error_share = kTrueRangeShare + 0.005 * random.normal();
    row.bearing_error_rad = 0.001 * random.normal();
    row.yaw_sigma_rad = kTrueSigma_rad;
    row.vision_ms = row.found ? 10.0 : 25.0;
    rows.push_back(row);
  }
  return rows;
}

/// An error that keeps its value for about a second: first order, 30 frames a second.
std::vector<FitRow> made_up_walk() {
  Random random(5);
  std::vector<FitRow> rows;
  double error = 0.0;
  const double kept = std::exp(-1.0 / 30.0);
  for (int i = 0; i < 30 * 120; ++i) {
    error = kept * error + std::sqrt(1.0 - kept * kept) * random.normal();
    FitRow row;
    row.t_s = i / 30.0;
    row.found = true;
    row.certainty = 0.4;
    row.aspect_error_rad = 0.02 * error;
    row.range_error_share = kTrueRangeShare + 0.005 * random.normal();
    row.yaw_sigma_rad = kTrueSigma_rad;
    rows.push_back(row);
  }
  return rows;
}

const ErrorModel& fitted() {
  static const ErrorModel model = fit_error_model(made_up_rows(6000, 3), made_up_walk());
  return model;
}

TEST(ErrorFit, FindsBiasSpreadAndOddsAgain) {
  for (const double distance_m : {1.5, 3.0, 4.5})
    for (const double aspect_rad : {-1.0, -0.3, 0.0, 0.6}) {
      ViewConditions c;
      c.distance_m = distance_m;
      c.aspect_rad = aspect_rad;
      SCOPED_TRACE(std::to_string(distance_m) + " m, " + std::to_string(aspect_rad) + " rad");
      EXPECT_NEAR(fitted().aspect_rad.bias(c), kTrueSlope * std::pow(aspect_rad, 3), 0.012);
      EXPECT_NEAR(fitted().range_share.bias(c), kTrueRangeShare, 0.001);
      EXPECT_NEAR(fitted().found_probability(c), found_probability(c), 0.05);
      EXPECT_NEAR(std::exp(fitted().certainty.mean_log(c)), std::exp(-0.5 * distance_m), 0.01);
    }
  ViewConditions near, far;
  near.distance_m = 1.5;
  far.distance_m = 4.5;
  EXPECT_NEAR(fitted().aspect_rad.spread(far) / fitted().aspect_rad.spread(near), 3.0, 0.6);
}

TEST(ErrorFit, TellsHowLongAnErrorLasts) {
  EXPECT_NEAR(fitted().aspect_rad.memory_s, 1.0, 0.35);
  EXPECT_LT(fitted().range_share.memory_s, 0.1) << "white noise is forgotten at once";
  EXPECT_LT(fitted().aspect_rad.print_share, 0.05) << "worlds do not differ";
}

TEST(ErrorFit, WhatDiffersBetweenWorldsIsKeptForARun) {
  auto rows = made_up_rows(6000, 4);
  // Half of the variance of a metre's 0.01 rad, by the world: alternating signs.
  for (FitRow& row : rows)
    row.aspect_error_rad += 0.01 * row.conditions.distance_m * (row.world % 2 == 0 ? 1.0 : -1.0);
  EXPECT_NEAR(fit_error_model(rows, made_up_walk()).aspect_rad.print_share, 0.5, 0.12);
}

TEST(ErrorFit, TooFewSightingsAreNamed) {
  EXPECT_THAT(test::complaint_of([] { fit_error_model(made_up_rows(20, 3), {}); }),
              HasSubstr("expected at least 200"));
}

TEST(ErrorConditions, WhatIsOutOfThePictureIsHidden) {
  EXPECT_EQ(conditions_of(0.0, 2.0, 0.0, 554, 320, 640, 0.0).hidden, 0.0);
  EXPECT_EQ(conditions_of(0.0, 2.0, 0.0, 554, 320, 640, -0.4).hidden, -0.4);
  // 1 m ahead the back is 177 px wide; its middle on the picture's right edge: half of it is out, on the
  // right.
  EXPECT_NEAR(conditions_of(320.0 / 554.0, 1.0, std::atan2(320, 554), 554, 320, 640, 0.0).hidden, -0.5, 0.01);
  EXPECT_NEAR(conditions_of(-320.0 / 554.0, 1.0, 0.0, 554, 320, 640, 0.0).hidden, 0.5, 0.01);
  EXPECT_NEAR(conditions_of(0.5, 2.0, 0.0, 554, 320, 640, 0.0).aspect_rad, -std::atan2(0.5, 2.0), 1e-12);
}

TEST(ErrorModelFile, ComesBackAsItWasWritten) {
  const test::TemporaryFolder folder;
  write_error_model(fitted(), "a test", folder.file("model.toml"));
  const ErrorModel back = read_error_model(folder.file("model.toml"));
  ViewConditions c;
  c.aspect_rad = 0.4;
  c.hidden = 0.2;
  EXPECT_NEAR(back.aspect_rad.bias(c), fitted().aspect_rad.bias(c), 1e-6);
  EXPECT_NEAR(back.found_probability(c), fitted().found_probability(c), 1e-6);
  EXPECT_NEAR(back.aspect_rad.residual[7], fitted().aspect_rad.residual[7], 1e-5);
  EXPECT_NEAR(back.time_share.mean_log(c), fitted().time_share.mean_log(c), 1e-6);
}

TEST(ErrorModelFile, RefusesByNameAndPlace) {
  const test::TemporaryFolder folder;
  write_error_model(fitted(), "a test", folder.file("model.toml"));
  const std::string whole = test::read_text(folder.file("model.toml"));
  const auto complaint = [&](const std::string& text) {
    return test::complaint_of([&] { read_error_model(test::write_text(folder.file("damaged.toml"), text)); });
  };
  std::string without = whole;
  without.replace(without.find("print_share"), 11, "print_shape");
  EXPECT_THAT(complaint(without), HasSubstr("aspect_rad.print_share: missing"));
  EXPECT_THAT(complaint(whole + "[bogus]\na = 1\n"), HasSubstr("bogus: no such key"));
  EXPECT_THAT(complaint("["), HasSubstr("damaged.toml:1:"));
  EXPECT_THROW(read_error_model(folder.file("none.toml")), Error);
}

/// A person who stands; the camera 2.5 m behind, turned so that the back is seen at an angle.
class SampledPosesTest : public ::testing::Test {
 protected:
  SampledPosesTest() {
    scenario_.camera.model = sim::default_camera_model();
    world_ = std::make_unique<sim::World>(scenario_, 1, sim::WorldUse::TruthOnly);
  }

  /// Frames a tenth of a second apart.
  void look(int frames, const std::function<void(const PoseEstimate&, const sim::Truth&)>& see) {
    const sim::RobotMotion robot{-2.5, 0.4, 0.1, 0.0, 0.0};
    const sim::Truth truth = world_->truth(robot, 0.0);
    SampledPoses poses(fitted(), scenario_, 1.5, 9);
    for (int i = 1; i <= frames; ++i) {
      FrameHeader header;
      header.sequence = static_cast<std::uint64_t>(i);
      header.t_capture_ns = i * kNsPerS / 10;
      see(poses.estimate(header, robot, truth), truth);
    }
  }

  sim::Scenario scenario_;
  std::unique_ptr<sim::World> world_;
};

TEST_F(SampledPosesTest, MeanAndSpreadAreTheModels) {
  double sum = 0.0, squares = 0.0, range = 0.0;
  int found = 0, all = 20000;
  ViewConditions c;
  look(all, [&](const PoseEstimate& pose, const sim::Truth& truth) {
    c = conditions_of(truth.back_in_camera_m.x(), truth.back_in_camera_m.z(), truth.yaw_rad, 554, 322.5, 640,
                      0.0);
    if (!pose.found()) return;
    ++found;
    const double aspect_rad = pose.yaw_rad - std::atan2(pose.position_m[0], pose.position_m[2]);
    sum += aspect_rad - c.aspect_rad;
    squares += std::pow(aspect_rad - c.aspect_rad, 2);
    range += std::hypot(pose.position_m[0], pose.position_m[2]) / c.distance_m - 1.0;
  });
  EXPECT_NEAR(found / static_cast<double>(all), found_probability(c), 0.03);
  const double mean = sum / found;
  EXPECT_NEAR(mean, kTrueSlope * std::pow(c.aspect_rad, 3), 0.006);
  EXPECT_NEAR(std::sqrt(squares / found - mean * mean), 0.01 * c.distance_m, 0.006);
  EXPECT_NEAR(range / found, kTrueRangeShare, 0.002);
}

TEST_F(SampledPosesTest, TheEstimateIsOfOnePiece) {
  int found = 0;
  look(20, [&](const PoseEstimate& pose, const sim::Truth& truth) {
    if (!pose.found()) return;
    ++found;
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(pose.R_cur_from_ref.data());
    const Eigen::Map<const Eigen::Vector3d> t(pose.t_over_d.data()), position(pose.position_m.data());
    EXPECT_NEAR(std::atan2(R(0, 2), R(2, 2)), pose.yaw_rad, 1e-9);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-9);
    // position = R c + d t/d, with the back's centre straight ahead in the reference view.
    const Eigen::Vector3d centre_ref(0.0, scenario_.camera.mount_z_m - truth.back_m.z(), 1.5);
    EXPECT_LT((R * centre_ref + 1.5 * t - position).norm(), 1e-9);
  });
  EXPECT_GT(found, 10);
}

TEST_F(SampledPosesTest, AnAvertedBackIsNeverFound) {
  const sim::RobotMotion ahead{2.5, 0.0, M_PI, 0.0, 0.0};
  SampledPoses poses(fitted(), scenario_, 1.5, 9);
  for (int i = 1; i < 200; ++i) {
    FrameHeader header;
    header.t_capture_ns = i * kNsPerS / 30;
    EXPECT_FALSE(poses.estimate(header, ahead, world_->truth(ahead, 0.0)).found());
  }
}

}  // namespace
}  // namespace heel::sim
