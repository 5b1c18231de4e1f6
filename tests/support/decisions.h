// What a control tick decided, for tests that compare two runs to the bit.
#pragma once

#include <cmath>
#include <set>
#include <string>

#include "heel/flow.h"

namespace heel::test {

/// The record's decisions as bytes, field by field: a struct has padding between them.
inline std::string decision_bytes(const TickRecord& record) {
  std::string bytes;
  const auto append = [&bytes](const auto&... fields) {
    (bytes.append(reinterpret_cast<const char*>(&fields), sizeof fields), ...);
  };
  const auto append_command = [&append](const VelocityCommand& c) {
    append(c.t_issued_ns, c.t_expires_ns, c.v_m_s, c.yaw_rate_rad_s, c.limited_by);
  };
  const TargetState& target = record.target;
  append(record.tick, record.measurement, record.conditions, record.stop_reason, record.free_distance_m);
  append(target.known, target.t_capture_ns, target.certainty, target.x_m, target.y_m, target.yaw_rad,
         target.travel_yaw_rad, target.travel_yaw_sigma_rad, target.stride_yaw_rad,
         target.stride_yaw_sigma_rad, target.body_odom_x_m, target.body_odom_y_m, target.body_sigma_m,
         target.walk_m_s, target.walk_sigma_m_s, target.aside_m_s, target.walk_turn_rad_s,
         target.walk_turn_sigma_rad_s, target.goal_x_m, target.goal_y_m);
  append_command(record.wanted);
  append_command(record.command);
  return bytes;
}

/// Counts the ticks of a run by what they did.
struct DecisionCounts {
  void add(const TickRecord& record) {
    moving += record.command.v_m_s != 0.0;
    accepted += record.measurement == MeasurementStatus::Accepted;
    obstacle_in_the_way += std::isfinite(record.free_distance_m);
    for (const SonarEcho& echo : record.input.robot.sonar) sonar_times_.insert(echo.t_ns);
    sonar_readings = static_cast<int>(sonar_times_.size());
    stop_reasons_.insert(record.stop_reason);
  }
  std::size_t stop_reasons() const { return stop_reasons_.size(); }

  int moving = 0;
  int accepted = 0;
  int obstacle_in_the_way = 0;
  int sonar_readings = 0;  ///< packets with sonar readings

 private:
  std::set<TimeNs> sonar_times_;
  std::set<StopReason> stop_reasons_;
};

}  // namespace heel::test
