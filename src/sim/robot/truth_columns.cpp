#include "sim/robot/truth_columns.h"

#include <array>

namespace heel::sim {
namespace {

using T = const RobotTruth&;

constexpr std::array<RobotTruthColumn, 8> kMotionColumns{{
    {"robot_x_m", 5, [](T t) { return t.pose.x_m; }},
    {"robot_y_m", 5, [](T t) { return t.pose.y_m; }},
    {"robot_heading_rad", 6, [](T t) { return t.pose.heading_rad; }},
    {"robot_v_m_s", 5, [](T t) { return t.v_m_s; }},
    {"robot_yaw_rate_rad_s", 6, [](T t) { return t.yaw_rate_rad_s; }},
    {"odom_x_m", 5, [](T t) { return t.odometry.x_m; }},
    {"odom_y_m", 5, [](T t) { return t.odometry.y_m; }},
    {"odom_heading_rad", 6, [](T t) { return t.odometry.heading_rad; }},
}};

constexpr std::array<RobotTruthColumn, 11> kStateColumns{{
    {"wheel_left_m_s", 5, [](T t) { return t.wheels.left_m_s; }},
    {"wheel_right_m_s", 5, [](T t) { return t.wheels.right_m_s; }},
    {"session_open", 0, [](T t) { return t.session == Session::Open ? 1.0 : 0.0; }},
    {"motors_enabled", 0, [](T t) { return t.motors_enabled ? 1.0 : 0.0; }},
    {"watchdog_stopped", 0, [](T t) { return t.watchdog_stopped ? 1.0 : 0.0; }},
    {"stall_left", 0, [](T t) { return t.stall_left ? 1.0 : 0.0; }},
    {"stall_right", 0, [](T t) { return t.stall_right ? 1.0 : 0.0; }},
    {"stop_button", 0, [](T t) { return t.stop_button ? 1.0 : 0.0; }},
    {"bumpers_front", 0, [](T t) { return static_cast<double>(t.bumpers_front); }},
    {"bumpers_rear", 0, [](T t) { return static_cast<double>(t.bumpers_rear); }},
    {"baud", 0, [](T t) { return static_cast<double>(t.baud); }},
}};

}  // namespace

std::span<const RobotTruthColumn> robot_motion_columns() {
  return kMotionColumns;
}

std::span<const RobotTruthColumn> robot_state_columns() {
  return kStateColumns;
}

}  // namespace heel::sim
