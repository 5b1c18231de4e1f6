#include "control/turn_monitor.h"

#include <algorithm>
#include <cmath>

#include "core/angles.h"

namespace heel {
namespace {

using Filter = ConstantVelocityFilter<2>;

constexpr double kPositionSigma_m = 0.02;  // vision, and the sway of the shirt
constexpr double kStartSpeed_m_s = 0.3;
constexpr double kAcceleration_m_s2 = 2.0;
constexpr double kSideways_m_s = 0.3;      // standard deviation of a person's speed sideways of their body
constexpr double kMostSideways_m_s = 1.5;  // a faster one is a leap of the pose
constexpr double kCorrelation_s = 0.25;    // two speeds this far apart count as two observations
constexpr double kMemory_s = 1.0;
constexpr TimeNs kSettling_ns = 200 * kNsPerMs;
constexpr TimeNs kLongestGap_ns = 500 * kNsPerMs;
constexpr double kSure = 6.0;  // e^6 : 1

Eigen::Vector2d in_odom(const Pose2& robot, double side, const Eigen::Vector2d& in_robot_m) {
  const double c = std::cos(robot.heading_rad), s = std::sin(robot.heading_rad);
  const double y_m = side * in_robot_m.y();
  return {robot.x_m + c * in_robot_m.x() - s * y_m, robot.y_m + s * in_robot_m.x() + c * y_m};
}

Filter::Matrix position_noise() {
  return kPositionSigma_m * kPositionSigma_m * Filter::Matrix::Identity();
}

double squared_at_most(double x, double most) {
  const double bounded = std::min(std::abs(x), most);
  return bounded * bounded;
}

}  // namespace

void TurnMonitor::Person::start(const Pose2& robot, const Sighting& sighting) {
  filter.start(in_odom(robot, side, sighting.position_m), position_noise(), kStartSpeed_m_s);
}

double TurnMonitor::Person::update(const Pose2& robot, const Sighting& sighting, double dt_s) {
  filter.predict(dt_s, kAcceleration_m_s2);
  filter.correct(in_odom(robot, side, sighting.position_m) - filter.position(), position_noise());
  const double facing_rad = robot.heading_rad + side * sighting.yaw_rad;
  return -std::sin(facing_rad) * filter.velocity().x() + std::cos(facing_rad) * filter.velocity().y();
}

void TurnMonitor::update(const OdometryHistory& odometry, TimeNs t_newest_ns) {
  std::size_t explained = 0;
  while (explained < waiting_count_ && waiting_[explained].t_ns <= t_newest_ns) {
    const Sighting& sighting = waiting_[explained++];
    if (const auto robot = odometry.pose_at(sighting.t_ns)) explain(sighting, *robot);
  }
  if (explained == 0) return;
  std::copy(waiting_.begin() + static_cast<std::ptrdiff_t>(explained),
            waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_count_), waiting_.begin());
  waiting_count_ -= explained;
}

void TurnMonitor::add_pose(const PoseEstimate& pose, const CameraMount& mount) {
  if (waiting_count_ == kWaiting) return;
  const auto measurement = measurement_from_pose(pose, mount);
  if (!measurement) return;
  waiting_[waiting_count_++] = {pose.t_capture_ns, measurement->position_m, measurement->yaw_rad};
}

void TurnMonitor::explain(const Sighting& sighting, const Pose2& robot) {
  if (t_start_ns_ != 0 && sighting.t_ns <= t_last_ns_) return;
  if (t_start_ns_ == 0 || sighting.t_ns - t_last_ns_ > kLongestGap_ns) {
    as_it_should_be_.start(robot, sighting);
    exchanged_.start(robot, sighting);
    t_start_ns_ = t_last_ns_ = sighting.t_ns;
    evidence_ = 0.0;
    return;
  }
  const double dt_s = seconds_from_ns(sighting.t_ns - t_last_ns_);
  t_last_ns_ = sighting.t_ns;
  const double slides_m_s = as_it_should_be_.update(robot, sighting, dt_s);
  const double exchanged_slides_m_s = exchanged_.update(robot, sighting, dt_s);
  if (t_last_ns_ - t_start_ns_ < kSettling_ns) return;
  const double difference = squared_at_most(slides_m_s, kMostSideways_m_s) -
                            squared_at_most(exchanged_slides_m_s, kMostSideways_m_s);
  evidence_ = std::exp(-dt_s / kMemory_s) * evidence_ +
              dt_s / kCorrelation_s * difference / (2.0 * kSideways_m_s * kSideways_m_s);
  turns_away_ = turns_away_ || evidence_ > kSure;
}

}  // namespace heel
