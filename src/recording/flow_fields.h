// Every field of every flow struct that is recorded, once. Schema, writer, reader and comparison are made
// from this table. fields(visitor, struct) calls visitor(name, field) in the order of the struct; a field
// that is missing here does not compile (flow_json_write.cpp).
#pragma once

#include <concepts>
#include <type_traits>

#include "heel/flow.h"

namespace heel {

/// T is R or const R.
template <typename T, typename R>
concept IsFlow = std::same_as<std::remove_const_t<T>, R>;

/// Two members that are one field: so many of these bytes.
template <typename Count, typename Bytes>
struct CountedBytes {
  Count& count;
  Bytes& bytes;
};
template <typename Count, typename Bytes>
CountedBytes(Count&, Bytes&) -> CountedBytes<Count, Bytes>;

template <typename V>
constexpr void fields(V& v, IsFlow<PoseEstimate> auto& p) {
  v("frame_sequence", p.frame_sequence);
  v("t_capture_ns", p.t_capture_ns);
  v("t_done_ns", p.t_done_ns);
  v("reason", p.reason);
  v("picture", p.picture);
  v("template_index", p.template_index);
  v("tracked", p.tracked);
  v("frame_features", p.frame_features);
  v("template_features", p.template_features);
  v("matches", p.matches);
  v("inliers", p.inliers);
  v("certainty", p.certainty);
  v("yaw_rad", p.yaw_rad);
  v("yaw_sigma_rad", p.yaw_sigma_rad);
  v("frame_yaw_rad", p.frame_yaw_rad);
  v("frame_yaw_sigma_rad", p.frame_yaw_sigma_rad);
  v("t_over_d", p.t_over_d);
  v("t_over_d_sigma", p.t_over_d_sigma);
  v("R_cur_from_ref", p.R_cur_from_ref);
  v("has_distance", p.has_distance);
  v("position_m", p.position_m);
  v("H_cur_from_ref", p.H_cur_from_ref);
}

template <typename V>
constexpr void fields(V& v, IsFlow<Odometry> auto& o) {
  v("t_ns", o.t_ns);
  v("x_m", o.x_m);
  v("y_m", o.y_m);
  v("heading_rad", o.heading_rad);
  v("v_m_s", o.v_m_s);
  v("yaw_rate_rad_s", o.yaw_rate_rad_s);
}

template <typename V>
constexpr void fields(V& v, IsFlow<SonarEcho> auto& e) {
  v("t_ns", e.t_ns);
  v("range_m", e.range_m);
}

template <typename V>
constexpr void fields(V& v, IsFlow<DriveLimits> auto& d) {
  v("known", d.known);
  v("acceleration_m_s2", d.acceleration_m_s2);
  v("deceleration_m_s2", d.deceleration_m_s2);
}

template <typename V>
constexpr void fields(V& v, IsFlow<RobotKind> auto& k) {
  v("robot_class", k.robot_class);
  v("subclass", k.subclass);
  v("choice", k.choice);
  v("model", k.model);
}

template <typename V>
constexpr void fields(V& v, IsFlow<RobotState> auto& r) {
  v("phase", r.phase);
  v("kind", r.kind);
  v("has_sip", r.has_sip);
  v("odometry", r.odometry);
  v("motors_enabled", r.motors_enabled);
  v("stop_button", r.stop_button);
  v("e_stall", r.e_stall);
  v("stall_left", r.stall_left);
  v("stall_right", r.stall_right);
  v("bumpers_front", r.bumpers_front);
  v("bumpers_rear", r.bumpers_rear);
  v("sonar", r.sonar);
  v("battery_v", r.battery_v);
  v("limits", r.limits);
  v("sips", r.sips);
  v("checksum_errors", r.checksum_errors);
  v("bytes_discarded", r.bytes_discarded);
  v("reconnects", r.reconnects);
}

template <typename V>
constexpr void fields(V& v, IsFlow<OperatorRequest> auto& r) {
  v("number", r.number);
  v("t_ns", r.t_ns);
  v("command", r.command);
}

template <typename V>
constexpr void fields(V& v, IsFlow<ControlInput> auto& i) {
  v("now_ns", i.now_ns);
  v("lateness_ns", i.lateness_ns);
  v("request", i.request);
  v("t_operator_ns", i.t_operator_ns);
  v("robot", i.robot);
  v("has_pose", i.has_pose);
  v("pose", i.pose);
  v("shutdown", i.shutdown);
}

template <typename V>
constexpr void fields(V& v, IsFlow<TargetState> auto& t) {
  v("known", t.known);
  v("t_capture_ns", t.t_capture_ns);
  v("certainty", t.certainty);
  v("x_m", t.x_m);
  v("y_m", t.y_m);
  v("yaw_rad", t.yaw_rad);
  v("travel_yaw_rad", t.travel_yaw_rad);
  v("travel_yaw_sigma_rad", t.travel_yaw_sigma_rad);
  v("stride_yaw_rad", t.stride_yaw_rad);
  v("stride_yaw_sigma_rad", t.stride_yaw_sigma_rad);
  v("body_odom_x_m", t.body_odom_x_m);
  v("body_odom_y_m", t.body_odom_y_m);
  v("body_sigma_m", t.body_sigma_m);
  v("walk_m_s", t.walk_m_s);
  v("walk_sigma_m_s", t.walk_sigma_m_s);
  v("aside_m_s", t.aside_m_s);
  v("walk_turn_rad_s", t.walk_turn_rad_s);
  v("walk_turn_sigma_rad_s", t.walk_turn_sigma_rad_s);
  v("goal_x_m", t.goal_x_m);
  v("goal_y_m", t.goal_y_m);
}

template <typename V>
constexpr void fields(V& v, IsFlow<VelocityCommand> auto& c) {
  v("t_issued_ns", c.t_issued_ns);
  v("t_expires_ns", c.t_expires_ns);
  v("v_m_s", c.v_m_s);
  v("yaw_rate_rad_s", c.yaw_rate_rad_s);
  v("limited_by", c.limited_by);
}

template <typename V>
constexpr void fields(V& v, IsFlow<TickRecord> auto& t) {
  v("tick", t.tick);
  v("configuration", t.configuration);
  v("input", t.input);
  v("measurement", t.measurement);
  v("target", t.target);
  v("conditions", t.conditions);
  v("state", t.state);
  v("cause", t.cause);
  v("t_transition_ns", t.t_transition_ns);
  v("stop_reason", t.stop_reason);
  v("request_number", t.request_number);
  v("outcome", t.outcome);
  v("refused_by", t.refused_by);
  v("needs_start", t.needs_start);
  v("enable_motors", t.enable_motors);
  v("wanted", t.wanted);
  v("person_m", t.person_m);
  v("free_distance_m", t.free_distance_m);
  v("hold", t.hold);
  v("planned_deceleration_m_s2", t.planned_deceleration_m_s2);
  v("brakes_are_weaker", t.brakes_are_weaker);
  v("command", t.command);
}

template <typename V>
constexpr void fields(V& v, IsFlow<CaptureCounters> auto& c) {
  v("t_ns", c.t_ns);
  v("captured", c.captured);
  v("dropped_by_driver", c.dropped_by_driver);
  v("dropped_unread", c.dropped_unread);
  v("reopened", c.reopened);
}

template <typename V>
constexpr void fields(V& v, IsFlow<FrameTiming> auto& f) {
  v("frame_sequence", f.frame_sequence);
  v("t_capture_ns", f.t_capture_ns);
  v("t_dequeued_ns", f.t_dequeued_ns);
  v("t_vision_ns", f.t_vision_ns);
  v("t_done_ns", f.t_done_ns);
}

template <typename V>
constexpr void fields(V& v, IsFlow<Event> auto& e) {
  v("t_ns", e.t_ns);
  v("kind", e.kind);
  v("a", e.a);
  v("b", e.b);
  v("text", e.text);
}

template <typename V>
constexpr void fields(V& v, IsFlow<WireBytes> auto& w) {
  v("t_ns", w.t_ns);
  v("to_robot", w.to_robot);
  v("bytes", CountedBytes{w.count, w.bytes});
}

}  // namespace heel
