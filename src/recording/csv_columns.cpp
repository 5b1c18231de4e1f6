#include "recording/csv_columns.h"

#include <fmt/format.h>

#include <limits>
#include <vector>

namespace heel {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double or_none(bool known, double value) {
  return known ? value : kNone;
}

/// Columns NAME_0 … NAME_(count−1).
template <typename Record>
void add_array(std::vector<CsvColumn<Record>>& columns, const std::string& name, int count,
               void (*write)(CsvLine&, const Record&, int)) {
  for (int i = 0; i < count; ++i) columns.push_back({fmt::format("{}_{}", name, i), write, i});
}

std::vector<CsvColumn<TickRecord>> make_tick_columns() {
  using T = TickRecord;
  using L = CsvLine;
  std::vector<CsvColumn<T>> columns{
      {"t_s", [](L& l, const T& t, int) { l.seconds(t.input.now_ns); }},
      {"tick", [](L& l, const T& t, int) { l.integer(t.tick); }},
      {"lateness_us",
       [](L& l, const T& t, int) { l.number(static_cast<double>(t.input.lateness_ns) * 1e-3); }},
      {"stop_code", [](L& l, const T& t, int) { l.integer(static_cast<std::uint64_t>(t.stop_reason)); }},
      {"stop_reason", [](L& l, const T& t, int) { l.text(to_string(t.stop_reason)); }},
      {"state_code", [](L& l, const T& t, int) { l.integer(static_cast<std::uint64_t>(t.state)); }},
      {"state", [](L& l, const T& t, int) { l.text(to_string(t.state)); }},
      {"cause", [](L& l, const T& t, int) { l.text(to_string(t.cause)); }},
      {"transition_s", [](L& l, const T& t, int) { l.seconds(t.t_transition_ns); }},
      {"hold", [](L& l, const T& t, int) { l.text(to_string(t.hold)); }},
      // The operator's newest request, and what became of it.
      {"request", [](L& l, const T& t, int) { l.integer(t.input.request.number); }},
      {"request_t_s", [](L& l, const T& t, int) { l.seconds(t.input.request.t_ns); }},
      {"request_command", [](L& l, const T& t, int) { l.text(to_string(t.input.request.command)); }},
      {"request_handled", [](L& l, const T& t, int) { l.integer(t.request_number); }},
      {"outcome", [](L& l, const T& t, int) { l.text(to_string(t.outcome)); }},
      {"refused_by",
       [](L& l, const T& t, int) {
         l.text(t.outcome == OperatorOutcome::Refused ? to_string(t.refused_by) : "none");
       }},
      {"operator_t_s", [](L& l, const T& t, int) { l.seconds(t.input.t_operator_ns); }},
      {"link_code",
       [](L& l, const T& t, int) { l.integer(static_cast<std::uint64_t>(t.input.robot.phase)); }},
      {"link_phase", [](L& l, const T& t, int) { l.text(to_string(t.input.robot.phase)); }},
      // The robot, from its newest packet.
      {"odom_t_s", [](L& l, const T& t, int) { l.seconds(t.input.robot.odometry.t_ns); }},
      {"odom_x_m",
       [](L& l, const T& t, int) { l.number(or_none(t.input.robot.has_sip, t.input.robot.odometry.x_m)); }},
      {"odom_y_m",
       [](L& l, const T& t, int) { l.number(or_none(t.input.robot.has_sip, t.input.robot.odometry.y_m)); }},
      {"odom_heading_rad",
       [](L& l, const T& t, int) {
         l.number(or_none(t.input.robot.has_sip, t.input.robot.odometry.heading_rad));
       }},
      {"odom_v_m_s",
       [](L& l, const T& t, int) { l.number(or_none(t.input.robot.has_sip, t.input.robot.odometry.v_m_s)); }},
      {"odom_yaw_rate_rad_s",
       [](L& l, const T& t, int) {
         l.number(or_none(t.input.robot.has_sip, t.input.robot.odometry.yaw_rate_rad_s));
       }},
      {"motors_enabled", [](L& l, const T& t, int) { l.flag(t.input.robot.motors_enabled); }},
      {"stop_button", [](L& l, const T& t, int) { l.flag(t.input.robot.stop_button); }},
      {"e_stall", [](L& l, const T& t, int) { l.flag(t.input.robot.e_stall); }},
      {"stall_left", [](L& l, const T& t, int) { l.flag(t.input.robot.stall_left); }},
      {"stall_right", [](L& l, const T& t, int) { l.flag(t.input.robot.stall_right); }},
      {"bumpers_front", [](L& l, const T& t, int) { l.integer(std::uint64_t{t.input.robot.bumpers_front}); }},
      {"bumpers_rear", [](L& l, const T& t, int) { l.integer(std::uint64_t{t.input.robot.bumpers_rear}); }},
      {"battery_v",
       [](L& l, const T& t, int) { l.number(or_none(t.input.robot.has_sip, t.input.robot.battery_v)); }},
      {"sips", [](L& l, const T& t, int) { l.integer(t.input.robot.sips); }},
      {"checksum_errors", [](L& l, const T& t, int) { l.integer(t.input.robot.checksum_errors); }},
      {"bytes_discarded", [](L& l, const T& t, int) { l.integer(t.input.robot.bytes_discarded); }},
      {"reconnects", [](L& l, const T& t, int) { l.integer(t.input.robot.reconnects); }},
      {"shutdown", [](L& l, const T& t, int) { l.flag(t.input.shutdown); }},
      // The newest pose, and what became of it.
      {"has_pose", [](L& l, const T& t, int) { l.flag(t.input.has_pose); }},
      {"pose_frame", [](L& l, const T& t, int) { l.integer(t.input.pose.frame_sequence); }},
      {"pose_t_capture_s", [](L& l, const T& t, int) { l.seconds(t.input.pose.t_capture_ns); }},
      {"measurement_code",
       [](L& l, const T& t, int) { l.integer(static_cast<std::uint64_t>(t.measurement)); }},
      {"measurement", [](L& l, const T& t, int) { l.text(to_string(t.measurement)); }},
      {"conditions", [](L& l, const T& t, int) { l.integer(std::uint64_t{t.conditions}); }},
      // The target in the robot frame, at the time of the tick.
      {"target_known", [](L& l, const T& t, int) { l.flag(t.target.known); }},
      {"target_t_capture_s", [](L& l, const T& t, int) { l.seconds(t.target.t_capture_ns); }},
      {"target_certainty",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.certainty)); }},
      {"target_x_m", [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.x_m)); }},
      {"target_y_m", [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.y_m)); }},
      {"target_yaw_rad", [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.yaw_rad)); }},
      {"target_travel_yaw_rad",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.travel_yaw_rad)); }},
      {"target_travel_yaw_sigma_rad",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.travel_yaw_sigma_rad)); }},
      {"target_stride_yaw_rad",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.stride_yaw_rad)); }},
      {"target_stride_yaw_sigma_rad",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.stride_yaw_sigma_rad)); }},
      {"target_body_odom_x_m",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.body_odom_x_m)); }},
      {"target_body_odom_y_m",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.body_odom_y_m)); }},
      {"target_body_sigma_m",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.body_sigma_m)); }},
      {"target_walk_m_s",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.walk_m_s)); }},
      {"target_walk_sigma_m_s",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.walk_sigma_m_s)); }},
      {"target_aside_m_s",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.aside_m_s)); }},
      {"target_walk_turn_rad_s",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.walk_turn_rad_s)); }},
      {"target_walk_turn_sigma_rad_s",
       [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.walk_turn_sigma_rad_s)); }},
      {"goal_x_m", [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.goal_x_m)); }},
      {"goal_y_m", [](L& l, const T& t, int) { l.number(or_none(t.target.known, t.target.goal_y_m)); }},
      // The command of the control law, and the command sent.
      {"wanted_v_m_s", [](L& l, const T& t, int) { l.number(t.wanted.v_m_s); }},
      {"wanted_yaw_rate_rad_s", [](L& l, const T& t, int) { l.number(t.wanted.yaw_rate_rad_s); }},
      {"command_v_m_s", [](L& l, const T& t, int) { l.number(t.command.v_m_s); }},
      {"command_yaw_rate_rad_s", [](L& l, const T& t, int) { l.number(t.command.yaw_rate_rad_s); }},
      {"command_expires_s", [](L& l, const T& t, int) { l.seconds(t.command.t_expires_ns); }},
      {"limited_by", [](L& l, const T& t, int) { l.integer(std::uint64_t{t.command.limited_by}); }},
      {"person_m", [](L& l, const T& t, int) { l.number(t.person_m); }},
      {"free_distance_m", [](L& l, const T& t, int) { l.number(t.free_distance_m); }},
      {"planned_deceleration_m_s2", [](L& l, const T& t, int) { l.number(t.planned_deceleration_m_s2); }},
  };
  add_array<T>(columns, "sonar_t_s", kMaxSonars, [](L& l, const T& t, int i) {
    l.seconds(t.input.robot.sonar[static_cast<std::size_t>(i)].t_ns);
  });
  add_array<T>(columns, "sonar_range_m", kMaxSonars, [](L& l, const T& t, int i) {
    const SonarEcho& echo = t.input.robot.sonar[static_cast<std::size_t>(i)];
    l.number(or_none(echo.t_ns != 0, echo.range_m));
  });
  return columns;
}

std::vector<CsvColumn<PoseEstimate>> make_pose_columns() {
  using P = PoseEstimate;
  using L = CsvLine;
  std::vector<CsvColumn<P>> columns{
      {"t_s", [](L& l, const P& p, int) { l.seconds(p.t_capture_ns); }},
      {"done_s", [](L& l, const P& p, int) { l.seconds(p.t_done_ns); }},
      {"frame", [](L& l, const P& p, int) { l.integer(p.frame_sequence); }},
      {"reason_code", [](L& l, const P& p, int) { l.integer(static_cast<std::uint64_t>(p.reason)); }},
      {"reason", [](L& l, const P& p, int) { l.text(to_string(p.reason)); }},
      {"picture", [](L& l, const P& p, int) { l.text(to_string(p.picture)); }},
      {"found", [](L& l, const P& p, int) { l.flag(p.found()); }},
      {"template", [](L& l, const P& p, int) { l.integer(std::uint64_t{p.template_index}); }},
      {"tracked", [](L& l, const P& p, int) { l.flag(p.tracked); }},
      {"certainty", [](L& l, const P& p, int) { l.number(p.certainty); }},
      {"inliers", [](L& l, const P& p, int) { l.integer(std::uint64_t{p.inliers}); }},
      {"matches", [](L& l, const P& p, int) { l.integer(std::uint64_t{p.matches}); }},
      {"frame_features", [](L& l, const P& p, int) { l.integer(std::uint64_t{p.frame_features}); }},
      {"template_features", [](L& l, const P& p, int) { l.integer(std::uint64_t{p.template_features}); }},
      {"yaw_rad", [](L& l, const P& p, int) { l.number(or_none(p.found(), p.yaw_rad)); }},
      {"yaw_sigma_rad", [](L& l, const P& p, int) { l.number(or_none(p.found(), p.yaw_sigma_rad)); }},
      {"frame_yaw_rad", [](L& l, const P& p, int) { l.number(or_none(p.found(), p.frame_yaw_rad)); }},
      {"frame_yaw_sigma_rad",
       [](L& l, const P& p, int) { l.number(or_none(p.found(), p.frame_yaw_sigma_rad)); }},
  };
  add_array<P>(columns, "t_over_d", 3,
               [](L& l, const P& p, int i) { l.number(or_none(p.found(), p.t_over_d[i])); });
  add_array<P>(columns, "t_over_d_sigma", 3,
               [](L& l, const P& p, int i) { l.number(or_none(p.found(), p.t_over_d_sigma[i])); });
  add_array<P>(columns, "position_m", 3, [](L& l, const P& p, int i) {
    l.number(or_none(p.found() && p.has_distance, p.position_m[i]));
  });
  add_array<P>(columns, "R_cur_from_ref", 9,
               [](L& l, const P& p, int i) { l.number(or_none(p.found(), p.R_cur_from_ref[i])); });
  add_array<P>(columns, "H_cur_from_ref", 9,
               [](L& l, const P& p, int i) { l.number(or_none(p.found(), p.H_cur_from_ref[i])); });
  return columns;
}

std::vector<CsvColumn<CaptureCounters>> make_capture_columns() {
  using C = CaptureCounters;
  using L = CsvLine;
  return {
      {"t_s", [](L& l, const C& c, int) { l.seconds(c.t_ns); }},
      {"captured", [](L& l, const C& c, int) { l.integer(c.captured); }},
      {"dropped_by_driver", [](L& l, const C& c, int) { l.integer(c.dropped_by_driver); }},
      {"dropped_unread", [](L& l, const C& c, int) { l.integer(c.dropped_unread); }},
      {"reopened", [](L& l, const C& c, int) { l.integer(c.reopened); }},
  };
}

}  // namespace

std::span<const CsvColumn<TickRecord>> tick_columns() {
  static const std::vector<CsvColumn<TickRecord>> columns = make_tick_columns();
  return columns;
}

std::span<const CsvColumn<PoseEstimate>> pose_columns() {
  static const std::vector<CsvColumn<PoseEstimate>> columns = make_pose_columns();
  return columns;
}

std::span<const CsvColumn<CaptureCounters>> capture_columns() {
  static const std::vector<CsvColumn<CaptureCounters>> columns = make_capture_columns();
  return columns;
}

}  // namespace heel
