// The daemon's link to the robot, ticked as its control thread does, for commands that talk to the robot
// themselves. Whatever happens, its end sends STOP and CLOSE.
#pragma once

#include <functional>
#include <string>

#include "preflight_step.h"
#include "robot/robot_link.h"

namespace heel::cli {

inline constexpr const char* kNoRobot = "check robot.address, the cable, and that the robot is switched on";

class TickedLink {
 public:
  explicit TickedLink(const RobotConfig& config) : link_(config) {}
  ~TickedLink();
  TickedLink(const TickedLink&) = delete;
  TickedLink& operator=(const TickedLink&) = delete;

  const RobotState& state() const { return link_.state(); }

  /// Commands this velocity until `done` or for so long; true: done. Ends early when interrupted.
  bool run(double v_m_s, double yaw_rate_rad_s, TimeNs longest_ns, const std::function<bool()>& done);
  /// False: nobody has answered.
  bool connect();

  /// What the robot, or the lack of one, has said last.
  std::string last_note() const;
  const std::string& kind() const { return kind_; }

 private:
  void note_events();

  RobotLink link_;
  std::string note_, kind_;
};

/// Fails the step where the robot is not ready to drive.
bool require_running(TickedLink& link, const RobotConfig& config, PreflightStep& step);

}  // namespace heel::cli
