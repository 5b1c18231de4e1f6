// The steps of `heel preflight` that talk to the robot, through the daemon's own link. Whatever happens, the
// link's end sends STOP and CLOSE.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/angles.h"
#include "heel/error.h"
#include "models/robot_models.h"
#include "preflight_step.h"
#include "ticked_link.h"

namespace heel::cli {
namespace {

constexpr TimeNs kListen_ns = 2 * kNsPerS;
constexpr double kLeastSips_1_s = 8.0;  // of ten

constexpr double kForwards_m_s = 0.1;
constexpr double kLeft_rad_s = 0.35;
constexpr TimeNs kMove_ns = 1500 * kNsPerMs, kRest_ns = kNsPerS;
constexpr double kLeastShare = 0.5;  // of the way that was commanded

}  // namespace

PreflightStep check_robot(const Config& config) {
  PreflightStep step{.name = "robot"};
  try {
    TickedLink link(config.robot);
    if (!require_running(link, config.robot, step)) return step;
    const std::uint64_t before = link.state().sips;
    link.run(0.0, 0.0, kListen_ns, [] { return false; });
    const RobotState& state = link.state();
    const double sips_1_s = static_cast<double>(state.sips - before) / seconds_from_ns(kListen_ns);
    const RobotGeometry& robot = robot_models()[state.kind.model].geometry;
    std::size_t fitted = 0, heard = 0;
    for (std::size_t i = 0; i < kMaxSonars; ++i) {
      if (!robot.looks_ahead(i)) continue;
      ++fitted;
      heard += state.sonar[i].t_ns != 0;
    }
    step.values = {{"robot", link.kind()},        {"battery_v", state.battery_v},
                   {"packets_1_s", sips_1_s},     {"front_sonars", fitted},
                   {"front_sonars_heard", heard}, {"checksum_errors", state.checksum_errors}};
    const std::string measured =
        fmt::format("{}; battery {:.1f} V, {:.0f} packets/s, {} of {} front sonars heard", link.kind(),
                    state.battery_v, sips_1_s, heard, fitted);
    if (state.battery_v < config.supervisor.battery_ok_v)
      return step.fail(measured, fmt::format("charge the battery (expected {:g} V, supervisor.battery_ok_v)",
                                             config.supervisor.battery_ok_v));
    if (sips_1_s < kLeastSips_1_s)
      return step.fail(measured, "check the cable and its length (expected 10 packets/s)");
    if (state.bumpers_front != 0 || state.bumpers_rear != 0)
      return step.fail(measured + ", a bumper is pressed", "free the bumper");
    if (config.robot.sonar && heard < fitted)
      return step.fail(measured,
                       "check the sonars' cable, or set robot.sonar = false: the robot then sees no "
                       "obstacle");
    return step.pass(measured);
  } catch (const Error& error) {
    return step.fail(error.what(), kNoRobot);
  }
}

PreflightStep check_wheels(const Config& config) {
  PreflightStep step{.name = "wheels"};
  try {
    TickedLink link(config.robot);
    if (!require_running(link, config.robot, step)) return step;
    const auto never = [] { return false; };
    const auto drive = [&](double v_m_s, double yaw_rate_rad_s) {
      const Odometry before = link.state().odometry;
      link.run(v_m_s, yaw_rate_rad_s, kMove_ns, never);
      link.run(0.0, 0.0, kRest_ns, never);
      const Odometry& after = link.state().odometry;
      const double dx_m = after.x_m - before.x_m, dy_m = after.y_m - before.y_m;
      return std::pair(dx_m * std::cos(before.heading_rad) + dy_m * std::sin(before.heading_rad),
                       after.heading_rad - before.heading_rad);
    };
    const double forwards_m = drive(kForwards_m_s, 0.0).first;
    const double left_rad = drive(0.0, kLeft_rad_s).second;
    const double move_s = seconds_from_ns(kMove_ns);
    const std::string measured = fmt::format(
        "commanded {:.2f} m forwards and {:.0f}° to the left: {:.2f} m and {:.0f}°", kForwards_m_s * move_s,
        kLeft_rad_s * move_s * kDegPerRad, forwards_m, left_rad * kDegPerRad);
    step.values = {{"forwards_m", forwards_m}, {"left_rad", left_rad}};
    if (g_preflight_interrupted) return step.fail(measured, "interrupted: the robot has been stopped");
    if (forwards_m < kLeastShare * kForwards_m_s * move_s)
      return step.fail(measured,
                       "the wheels do not turn forwards as odometry counts: check their connectors "
                       "and encoders");
    if (left_rad < kLeastShare * kLeft_rad_s * move_s)
      return step.fail(measured,
                       "the robot does not turn to the left as odometry counts: are the wheels of "
                       "left and right exchanged?");
    return step.pass(measured + "; did the wheels turn so?");
  } catch (const Error& error) {
    return step.fail(error.what(), kNoRobot);
  }
}

}  // namespace heel::cli
