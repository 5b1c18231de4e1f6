#include "sim/transport/truth_csv.h"

#include <cerrno>
#include <cstring>

#include "heel/error.h"

namespace heel::sim {

TruthCsv::TruthCsv(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "w")) {
  if (!file_) throw Error("--truth " + path + ": cannot write: " + std::strerror(errno));
}

void TruthCsv::column(const std::string& name, int decimals, std::function<double()> value) {
  columns_.push_back({name, decimals, std::move(value)});
}

void TruthCsv::write_row() {
  const char* separator = "";
  for (std::size_t i = 0; !has_header_ && i < columns_.size(); ++i) {
    std::fprintf(file_.get(), "%s%s", separator, columns_[i].name.c_str());
    separator = ",";
  }
  if (!has_header_) std::fputc('\n', file_.get());
  has_header_ = true;
  separator = "";
  for (const Column& column : columns_) {
    std::fprintf(file_.get(), "%s%.*f", separator, column.decimals, column.value());
    separator = ",";
  }
  std::fputc('\n', file_.get());
  if (std::ferror(file_.get()) != 0)
    throw Error("--truth " + path_ + ": write failed: " + std::strerror(errno));
}

void add_robot_columns(TruthCsv& truth, const P3At& robot) {
  const auto add = [&truth, &robot](const char* name, int decimals, auto field) {
    truth.column(name, decimals, [&robot, field] { return static_cast<double>(field(robot.truth())); });
  };
  using T = const RobotTruth&;
  add("t_s", 3, [](T now) { return seconds_from_ns(now.t_ns); });
  add("robot_x_m", 5, [](T now) { return now.pose.x_m; });
  add("robot_y_m", 5, [](T now) { return now.pose.y_m; });
  add("robot_heading_rad", 6, [](T now) { return now.pose.heading_rad; });
  add("robot_v_m_s", 5, [](T now) { return now.v_m_s; });
  add("robot_yaw_rate_rad_s", 6, [](T now) { return now.yaw_rate_rad_s; });
  add("odom_x_m", 5, [](T now) { return now.odometry.x_m; });
  add("odom_y_m", 5, [](T now) { return now.odometry.y_m; });
  add("odom_heading_rad", 6, [](T now) { return now.odometry.heading_rad; });
  add("wheel_left_m_s", 5, [](T now) { return now.wheels.left_m_s; });
  add("wheel_right_m_s", 5, [](T now) { return now.wheels.right_m_s; });
  add("session_open", 0, [](T now) { return now.session == Session::Open; });
  add("motors_enabled", 0, [](T now) { return now.motors_enabled; });
  add("watchdog_stopped", 0, [](T now) { return now.watchdog_stopped; });
  add("stall_left", 0, [](T now) { return now.stall_left; });
  add("stall_right", 0, [](T now) { return now.stall_right; });
  add("stop_button", 0, [](T now) { return now.stop_button; });
  add("bumpers_front", 0, [](T now) { return now.bumpers_front; });
  add("bumpers_rear", 0, [](T now) { return now.bumpers_rear; });
  add("baud", 0, [](T now) { return now.baud; });
}

}  // namespace heel::sim
