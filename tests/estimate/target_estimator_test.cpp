// The target in the odometry frame against truth: the robot moves and turns, frames arrive late, the person
// stands, walks straight and walks along bends, and a measurement is wrong.
#include "estimate/target_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/angles.h"
#include "estimate/floor_truth.h"

namespace heel {
namespace {

using test::in_robot;
using test::measured;
using test::moved;

/// Robot packets at 10 Hz, frames at 30 Hz that arrive late, both from exact motion.
struct Scene {
  Config config;
  test::Reference reference;
  Pose2 robot{0.0, 0.0, 0.0};
  Pose2 person{2.5, 0.0, 0.0};
  double v_m_s = 0.0, yaw_rate_rad_s = 0.0;
  double person_v_m_s = 0.0, person_yaw_rate_rad_s = 0.0;
  TimeNs latency_ns = 60 * kNsPerMs;
  std::function<void(PoseEstimate&)> disturb = [](PoseEstimate&) {};

  TargetEstimator estimator{config};
  TimeNs now_ns = kNsPerS;
  std::vector<PoseEstimate> in_flight;

  void run(double seconds) {
    const TimeNs end_ns = now_ns + ns_from_seconds(seconds);
    for (; now_ns < end_ns; now_ns += 10 * kNsPerMs) {
      if (now_ns % (100 * kNsPerMs) == 0) {
        estimator.add_odometry(test::odometry(now_ns, robot, v_m_s, yaw_rate_rad_s));
      }
      if (now_ns % (30 * kNsPerMs) == 0) {
        in_flight.push_back(measured(person, robot, mount_of(config.camera), reference));
        in_flight.back().t_capture_ns = now_ns;
        disturb(in_flight.back());
      }
      while (!in_flight.empty() && in_flight.front().t_capture_ns + latency_ns <= now_ns) {
        estimator.update(in_flight.front());
        in_flight.erase(in_flight.begin());
      }
      robot = moved(robot, v_m_s, yaw_rate_rad_s, 0.01);
      person = moved(person, person_v_m_s, person_yaw_rate_rad_s, 0.01);
    }
  }

  double position_error_m() const {
    const TargetState target = estimator.predict(now_ns);
    return target.known
               ? (in_robot(robot, person.x_m, person.y_m) - Eigen::Vector2d(target.x_m, target.y_m)).norm()
               : 1e9;
  }
  double yaw_error_rad() const {
    return wrap_angle_rad(estimator.predict(now_ns).yaw_rad - (person.heading_rad - robot.heading_rad));
  }
};

TEST(TargetEstimator, HasNoTargetBeforeTheFirstFrame) {
  Scene scene;
  EXPECT_FALSE(scene.estimator.predict(scene.now_ns).known);
}

TEST(TargetEstimator, PlacesAFrameWhereTheRobotWasWhenItWasTaken) {
  Scene scene;
  scene.person = {3.0, 0.5, 0.4};
  scene.v_m_s = 0.6;
  scene.yaw_rate_rad_s = 0.9;
  scene.latency_ns = 120 * kNsPerMs;  // the robot turns by 0.11 rad: 0.3 m at 3 m if ignored
  scene.run(1.5);
  EXPECT_LT(scene.position_error_m(), 2e-3);  // only the chord between two packets remains
  EXPECT_NEAR(scene.yaw_error_rad(), 0.0, 1e-6);
}

TEST(TargetEstimator, PredictsAWalkingAndTurningPerson) {
  Scene scene;
  scene.person_v_m_s = 1.0;
  scene.person_yaw_rate_rad_s = 0.4;
  scene.v_m_s = 0.6;
  scene.run(3.0);
  // Without prediction the error would be 0.06 m (60 ms of walking) and 0.024 rad (of turning).
  EXPECT_LT(scene.position_error_m(), 0.03);
  EXPECT_LT(std::abs(scene.yaw_error_rad()), 0.01);
}

TEST(TargetEstimator, WithoutFramesWalkingIsPredictedForLongerThanTurning) {
  Scene scene;
  scene.person_v_m_s = 1.0;
  scene.person_yaw_rate_rad_s = 0.5;
  scene.run(2.0);
  scene.disturb = [](PoseEstimate& pose) { pose.reason = PoseReason::TooFewMatches; };
  scene.run(0.1);  // the delayed frames arrive
  const TimeNs seen_ns = scene.estimator.predict(scene.now_ns).t_capture_ns;
  const TargetState seen = scene.estimator.predict(seen_ns);
  const auto after = [&](int ms) {
    while (scene.now_ns < seen_ns + ms * kNsPerMs) scene.run(0.01);
    return scene.estimator.predict(seen_ns + ms * kNsPerMs);
  };
  const auto walked_m = [](const TargetState& from, const TargetState& to) {
    return std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
  };
  const TargetState turned = after(200), walked = after(500), later = after(900);
  EXPECT_NEAR(turned.yaw_rad - seen.yaw_rad, 0.1, 0.01);
  EXPECT_EQ(walked.yaw_rad, turned.yaw_rad);
  EXPECT_NEAR(walked_m(seen, walked), 0.5, 0.02);
  EXPECT_NEAR(walked_m(walked, later), 0.0, 1e-12);
}

TEST(TargetEstimator, YawIsContinuousAcrossHalfATurn) {
  Scene scene;
  scene.person = {2.0, 0.0, 3.0};
  scene.robot.heading_rad = 3.1;
  scene.person = {-2.0, 0.0, 3.0};
  scene.person_yaw_rate_rad_s = 0.5;  // passes through pi
  scene.run(1.0);
  EXPECT_LT(std::abs(scene.yaw_error_rad()), 0.01);
}

TEST(TargetEstimator, SmoothsNoiseWithoutBias) {
  Scene scene;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.08);
  scene.disturb = [&](PoseEstimate& pose) {
    // Vision's yaw error: a rotation about the shirt's centre, with its sigma stated.
    const double wrong_rad = noise(random);
    pose = measured({2.5, 0.0, wrong_rad}, {}, mount_of(scene.config.camera), scene.reference);
    pose.t_capture_ns = scene.now_ns;
    pose.frame_yaw_sigma_rad = 0.08;
  };
  double sum = 0.0, squares = 0.0;
  scene.run(1.0);
  for (int i = 0; i < 1000; ++i) {
    scene.run(0.03);
    sum += scene.yaw_error_rad();
    squares += scene.yaw_error_rad() * scene.yaw_error_rad();
  }
  EXPECT_NEAR(sum / 1000, 0.0, 0.01);
  EXPECT_LT(std::sqrt(squares / 1000), 0.05);  // measurements: 0.08
}

TEST(TargetEstimator, TheDirectionOfTravelOfAPersonWhoStandsIsTheYawOfTheBack) {
  Scene scene;
  scene.robot.heading_rad = 0.3;
  scene.person.heading_rad = 0.7;
  scene.run(0.5);
  const TargetState target = scene.estimator.predict(scene.now_ns);
  EXPECT_NEAR(target.yaw_rad, 0.4, 1e-9);
  EXPECT_NEAR(target.travel_yaw_rad, 0.4, 1e-9);
  EXPECT_NEAR(target.stride_yaw_rad, 0.4, 1e-9);
  EXPECT_GT(target.travel_yaw_sigma_rad, 0.02);
  EXPECT_LT(target.travel_yaw_sigma_rad, 0.12);
  EXPECT_LT(target.stride_yaw_sigma_rad, target.travel_yaw_sigma_rad);
}

TEST(TargetEstimator, TheDirectionOfTravelAndTheGoalDoNotSwingWithTheBack) {
  Scene scene;
  scene.person_v_m_s = 0.8;
  scene.v_m_s = 0.8;
  scene.disturb = [&scene](PoseEstimate& pose) {
    Pose2 swinging = scene.person;
    swinging.heading_rad += 0.12 * std::sin(4.5 * seconds_from_ns(scene.now_ns));
    pose = measured(swinging, scene.robot, mount_of(scene.config.camera), scene.reference);
    pose.t_capture_ns = scene.now_ns;
  };
  scene.run(5.0);
  double back_rad = 0.0, travel_rad = 0.0, stride_rad = 0.0, goal_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    scene.run(0.01);
    const TargetState target = scene.estimator.predict(scene.now_ns);
    back_rad = std::max(back_rad, std::abs(target.yaw_rad));
    travel_rad = std::max(travel_rad, std::abs(target.travel_yaw_rad));
    stride_rad = std::max(stride_rad, std::abs(target.stride_yaw_rad));
    goal_m = std::max(goal_m, std::abs(target.goal_y_m));
  }
  const double behind_m = scene.reference.distance_m() + mount_of(scene.config.camera).x_m;
  EXPECT_GT(back_rad, 0.1);
  EXPECT_LT(travel_rad, 0.04);
  EXPECT_LT(stride_rad, 0.015);
  EXPECT_LT(goal_m, 0.04 * behind_m);
}

TEST(TargetEstimator, RejectsOneOutlier) {
  Scene scene;
  scene.run(1.0);
  PoseEstimate outlier =
      measured({2.5, 1.5, 0.0}, scene.robot, mount_of(scene.config.camera), scene.reference);
  outlier.t_capture_ns = scene.now_ns;
  EXPECT_EQ(scene.estimator.update(outlier), MeasurementStatus::Outlier);
  EXPECT_LT(scene.position_error_m(), 1e-6);
}

TEST(TargetEstimator, RestartsAfterOutliersInARow) {
  Scene scene;
  scene.run(1.0);
  scene.person = {3.5, 1.5, 0.5};
  scene.run(0.03 * scene.config.estimate.outliers_to_reset + 0.1);
  EXPECT_LT(scene.position_error_m(), 1e-6);
}

TEST(TargetEstimator, StartsAgainFromTheMeasurementAfterALongGap) {
  Scene scene;
  scene.person_v_m_s = 1.0;
  scene.run(3.0);
  const auto shown = scene.disturb;
  scene.disturb = [](PoseEstimate& pose) { pose.reason = PoseReason::TooFewMatches; };
  scene.run(0.1);
  scene.person_v_m_s = 0.0;
  const TimeNs before_ns = scene.estimator.predict(scene.now_ns).t_capture_ns;
  scene.run(1.5);
  scene.disturb = shown;
  while (scene.estimator.predict(scene.now_ns).t_capture_ns == before_ns) scene.run(0.01);
  EXPECT_LT(scene.position_error_m(), 1e-6);
  const TargetState then = scene.estimator.predict(scene.now_ns);
  const TargetState later = scene.estimator.predict(scene.now_ns + 200 * kNsPerMs);
  EXPECT_NEAR(std::hypot(later.x_m - then.x_m, later.y_m - then.y_m), 0.0, 1e-9)
      << "the speed of before the gap no longer counts";
}

TEST(TargetEstimator, RejectsFramesThatAreNotNewer) {
  Scene scene;
  scene.run(0.5);
  PoseEstimate pose = measured(scene.person, scene.robot, mount_of(scene.config.camera), scene.reference);
  pose.t_capture_ns = scene.now_ns;
  EXPECT_EQ(scene.estimator.update(pose), MeasurementStatus::Accepted);
  EXPECT_EQ(scene.estimator.update(pose), MeasurementStatus::OutOfOrder);
  pose.t_capture_ns -= kNsPerMs;
  EXPECT_EQ(scene.estimator.update(pose), MeasurementStatus::OutOfOrder);
}

TEST(TargetEstimator, EveryRefusalNamesItsGate) {
  Scene scene;
  scene.run(0.5);
  PoseEstimate pose = measured(scene.person, scene.robot, mount_of(scene.config.camera), scene.reference);
  pose.t_capture_ns = scene.now_ns;
  PoseEstimate ambiguous = pose;
  ambiguous.reason = PoseReason::Ambiguous;
  EXPECT_EQ(scene.estimator.update(ambiguous), MeasurementStatus::NotFound);
  PoseEstimate without_distance = pose;
  without_distance.has_distance = false;
  EXPECT_EQ(scene.estimator.update(without_distance), MeasurementStatus::Unusable);
  EXPECT_EQ(TargetEstimator(scene.config).update(pose), MeasurementStatus::NoOdometry);
  EXPECT_EQ(scene.estimator.update(pose), MeasurementStatus::Accepted);
}

TEST(TargetEstimator, ResetDiscardsTheTarget) {
  Scene scene;
  scene.run(0.5);
  scene.estimator.reset();
  EXPECT_FALSE(scene.estimator.predict(scene.now_ns).known);
}

TEST(Goal, IsTheRobotsPlaceInTheReferenceView) {
  Scene scene;
  scene.reference.centre_m = {0.2, 0.1, 2.0};
  const CameraMount mount = mount_of(scene.config.camera);
  // With the person here a robot at the origin has the reference view: 2 m ahead of the camera, 0.2 m to
  // its right.
  scene.person = {mount.x_m + 2.0, mount.y_m - 0.2, 0.0};
  scene.run(0.3);
  const TargetState target = scene.estimator.predict(scene.now_ns);
  EXPECT_NEAR(target.goal_x_m, 0.0, 1e-9);
  EXPECT_NEAR(target.goal_y_m, 0.0, 1e-9);
  EXPECT_NEAR(target.yaw_rad, 0.0, 1e-9);
}

TEST(Goal, IsBehindThePersonAlongTheirDirection) {
  Scene scene;
  scene.person = {3.0, 1.0, 0.6};
  scene.run(0.3);
  const TargetState target = scene.estimator.predict(scene.now_ns);
  const double behind_m = 2.0 + mount_of(scene.config.camera).x_m;
  EXPECT_NEAR(target.goal_x_m, 3.0 - behind_m * std::cos(0.6), 1e-9);
  EXPECT_NEAR(target.goal_y_m, 1.0 - behind_m * std::sin(0.6), 1e-9);
}

TEST(Goal, SetPointsMoveItAsTheConfigurationKeysSay) {
  Scene scene;
  scene.person = {3.0, 0.0, 0.0};
  scene.run(0.3);
  const auto goal_with = [&scene](double t_z, double t_x, double yaw) {
    Config config = scene.config;
    config.control.setpoint_t_z_m = t_z;
    config.control.setpoint_t_x_m = t_x;
    config.control.setpoint_yaw_rad = yaw;
    scene.estimator.reconfigure(config);
    const TargetState target = scene.estimator.predict(scene.now_ns);
    return Eigen::Vector2d(target.goal_x_m, target.goal_y_m);
  };
  const Eigen::Vector2d plain = goal_with(0, 0, 0);
  EXPECT_TRUE((goal_with(0.5, 0, 0) - plain).isApprox(Eigen::Vector2d(-0.5, 0)));  // farther behind
  EXPECT_TRUE((goal_with(0, 0.5, 0) - plain).isApprox(Eigen::Vector2d(0, 0.5)));   // to the person's left
  EXPECT_LT(goal_with(0, 0, 0.3).y(), -0.5);  // to the person's right …
  const Eigen::Vector2d person(3.0, 0.0);
  EXPECT_NEAR((goal_with(0, 0, 0.3) - person).norm(), (plain - person).norm(),
              1e-9);  // … at the same distance
}

}  // namespace
}  // namespace heel
