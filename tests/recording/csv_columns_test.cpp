#include "recording/csv_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel {
namespace {

std::vector<std::string> split(std::string text) {
  if (!text.empty() && text.back() == '\n') text.pop_back();
  std::vector<std::string> cells;
  std::istringstream in(text);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

template <typename Record>
std::map<std::string, std::string> row_of(std::span<const CsvColumn<Record>> columns, const Record& record) {
  CsvLine line;
  const std::vector<std::string> names = split(csv_header(columns));
  const std::vector<std::string> cells = split(std::string(csv_row(line, columns, record)));
  EXPECT_EQ(names.size(), cells.size());
  std::map<std::string, std::string> row;
  for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i) row[names[i]] = cells[i];
  return row;
}

TEST(CsvColumns, ATicksValuesAreUnderTheirColumnNames) {
  TickRecord tick;
  tick.tick = 17;
  tick.input.now_ns = 2'500'000'000;
  tick.input.lateness_ns = 12'500;
  tick.stop_reason = StopReason::Bumper;
  tick.state = SupervisorState::Stopped;
  tick.cause = TransitionCause::Bumper;
  tick.t_transition_ns = 2'250'000'000;
  tick.hold = Hold::ObstacleAhead;
  tick.input.request = {3, 2'125'000'000, OperatorCommand::Start};
  tick.input.t_operator_ns = 2'375'000'000;
  tick.request_number = 2;
  tick.outcome = OperatorOutcome::Refused;
  tick.refused_by = StopReason::Stall;
  tick.person_m = 1.75;
  tick.input.robot.phase = LinkPhase::Running;
  tick.input.robot.has_sip = true;
  tick.input.robot.odometry = {2'400'000'000, 1.5, -2.5, 7.25, 0.125, -0.5};
  tick.input.robot.bumpers_front = 5;
  tick.input.robot.battery_v = 12.25;
  tick.input.robot.sonar[15] = {2'375'000'000, 0.75};
  tick.input.shutdown = true;
  tick.input.has_pose = true;
  tick.input.pose.frame_sequence = 41;
  tick.input.pose.t_capture_ns = 2'450'000'000;
  tick.measurement = MeasurementStatus::Outlier;
  tick.conditions = kBumper | kTargetLost;
  tick.free_distance_m = 1.125;
  tick.planned_deceleration_m_s2 = 0.375;
  tick.target.known = true;
  tick.target.x_m = 2.0;
  tick.target.yaw_rad = -0.75;
  tick.target.travel_yaw_rad = -0.5;
  tick.target.travel_yaw_sigma_rad = 0.0625;
  tick.target.stride_yaw_rad = -0.625;
  tick.target.stride_yaw_sigma_rad = 0.03125;
  tick.target.body_odom_x_m = 3.5;
  tick.target.body_odom_y_m = -4.5;
  tick.target.body_sigma_m = 0.125;
  tick.target.walk_m_s = 0.875;
  tick.target.walk_sigma_m_s = 0.1875;
  tick.target.aside_m_s = -0.25;
  tick.target.walk_turn_rad_s = 0.375;
  tick.target.walk_turn_sigma_rad_s = 0.4375;
  tick.target.goal_y_m = 0.0625;
  tick.wanted.v_m_s = 0.75;
  tick.command.v_m_s = 0.5;
  tick.command.yaw_rate_rad_s = 0.25;
  tick.command.t_expires_ns = 2'700'000'000;
  tick.command.limited_by = kGateSpeed | kGateAge;
  const auto row = row_of(tick_columns(), tick);
  const std::map<std::string, std::string> expected{
      {"t_s", "2.500000000"},
      {"tick", "17"},
      {"lateness_us", "12.5"},
      {"stop_reason", "bumper pressed"},
      {"link_phase", "running"},
      {"state_code", "5"},
      {"state", "stopped"},
      {"cause", "bumper pressed"},
      {"transition_s", "2.250000000"},
      {"hold", "obstacle ahead"},
      {"request", "3"},
      {"request_t_s", "2.125000000"},
      {"request_command", "start"},
      {"request_handled", "2"},
      {"outcome", "refused"},
      {"refused_by", "wheels stalled"},
      {"operator_t_s", "2.375000000"},
      {"person_m", "1.75"},
      {"odom_t_s", "2.400000000"},
      {"odom_x_m", "1.5"},
      {"odom_y_m", "-2.5"},
      {"odom_heading_rad", "7.25"},
      {"odom_v_m_s", "0.125"},
      {"odom_yaw_rate_rad_s", "-0.5"},
      {"bumpers_front", "5"},
      {"battery_v", "12.25"},
      {"sonar_t_s_15", "2.375000000"},
      {"sonar_range_m_15", "0.75"},
      {"shutdown", "1"},
      {"has_pose", "1"},
      {"pose_frame", "41"},
      {"pose_t_capture_s", "2.450000000"},
      {"measurement_code", "6"},
      {"measurement", "outlier"},
      {"conditions", "1056"},
      {"free_distance_m", "1.125"},
      {"planned_deceleration_m_s2", "0.375"},
      {"target_x_m", "2"},
      {"target_yaw_rad", "-0.75"},
      {"target_travel_yaw_rad", "-0.5"},
      {"target_travel_yaw_sigma_rad", "0.0625"},
      {"target_stride_yaw_rad", "-0.625"},
      {"target_stride_yaw_sigma_rad", "0.03125"},
      {"target_body_odom_x_m", "3.5"},
      {"target_body_odom_y_m", "-4.5"},
      {"target_body_sigma_m", "0.125"},
      {"target_walk_m_s", "0.875"},
      {"target_walk_sigma_m_s", "0.1875"},
      {"target_aside_m_s", "-0.25"},
      {"target_walk_turn_rad_s", "0.375"},
      {"target_walk_turn_sigma_rad_s", "0.4375"},
      {"goal_y_m", "0.0625"},
      {"wanted_v_m_s", "0.75"},
      {"command_v_m_s", "0.5"},
      {"command_expires_s", "2.700000000"},
      {"command_yaw_rate_rad_s", "0.25"},
      {"limited_by", "5"},
  };
  for (const auto& [name, value] : expected) EXPECT_EQ(row.at(name), value) << name;
}

TEST(CsvColumns, UnknownValuesAreNan) {
  const auto tick = row_of(tick_columns(), TickRecord{});
  for (const char* name : {"odom_x_m", "battery_v", "sonar_range_m_0", "target_x_m", "target_yaw_rad",
                           "target_travel_yaw_rad", "target_stride_yaw_sigma_rad", "goal_x_m"}) {
    EXPECT_EQ(tick.at(name), "nan") << name;
  }
  PoseEstimate estimate;
  estimate.reason = PoseReason::Found;
  EXPECT_EQ(row_of(pose_columns(), estimate).at("position_m_0"), "nan") << "the distance is not known";
  estimate.reason = PoseReason::TooFewMatches;
  const auto pose = row_of(pose_columns(), estimate);
  EXPECT_EQ(pose.at("reason"), "too few matches");
  for (const char* name : {"yaw_rad", "t_over_d_2", "H_cur_from_ref_8", "R_cur_from_ref_0"}) {
    EXPECT_EQ(pose.at(name), "nan") << name;
  }
}

TEST(CsvColumns, APosesValuesAreUnderTheirColumnNames) {
  PoseEstimate estimate;
  estimate.reason = PoseReason::Found;
  estimate.frame_sequence = 99;
  estimate.t_capture_ns = 1'000'000'000;
  estimate.t_done_ns = 1'020'000'000;
  estimate.tracked = true;
  estimate.template_index = 2;
  estimate.certainty = 0.375;
  estimate.has_distance = true;
  for (std::size_t i = 0; i < 9; ++i) {
    const double value = 0.5 + static_cast<double>(i);
    estimate.R_cur_from_ref[i] = 30.0 + value;
    estimate.H_cur_from_ref[i] = 40.0 + value;
    if (i >= 3) continue;
    estimate.t_over_d[i] = value;
    estimate.position_m[i] = 10.0 + value;
    estimate.t_over_d_sigma[i] = 20.0 + value;
  }
  const auto row = row_of(pose_columns(), estimate);
  EXPECT_EQ(row.at("t_s"), "1.000000000");
  EXPECT_EQ(row.at("done_s"), "1.020000000");
  EXPECT_EQ(row.at("frame"), "99");
  EXPECT_EQ(row.at("found"), "1");
  EXPECT_EQ(row.at("tracked"), "1");
  EXPECT_EQ(row.at("template"), "2");
  EXPECT_EQ(row.at("certainty"), "0.375");
  for (int i = 0; i < 9; ++i) {
    const std::string n = "_" + std::to_string(i);
    const std::string value = std::to_string(i) + ".5";
    EXPECT_EQ(row.at("R_cur_from_ref" + n), "3" + value);
    EXPECT_EQ(row.at("H_cur_from_ref" + n), "4" + value);
    if (i >= 3) continue;
    EXPECT_EQ(row.at("t_over_d" + n), value);
    EXPECT_EQ(row.at("position_m" + n), "1" + value);
    EXPECT_EQ(row.at("t_over_d_sigma" + n), "2" + value);
  }
}

TEST(CsvColumns, CaptureCountersAreUnderTheirColumnNames) {
  const CaptureCounters counts{
      .t_ns = 1'250'000'000, .captured = 7, .dropped_by_driver = 5, .dropped_unread = 3, .reopened = 2};
  const auto row = row_of(capture_columns(), counts);
  EXPECT_EQ(row.at("t_s"), "1.250000000");
  EXPECT_EQ(row.at("captured"), "7");
  EXPECT_EQ(row.at("dropped_by_driver"), "5");
  EXPECT_EQ(row.at("dropped_unread"), "3");
  EXPECT_EQ(row.at("reopened"), "2");
}

// Arrays are documented by their first and last column.
bool in_the_middle_of_an_array(const std::string& name, const std::set<std::string>& names) {
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  if (digits == name.size() || name[digits - 1] != '_' || name[digits] == '0') return false;
  return names.contains(name.substr(0, digits) + std::to_string(std::stoi(name.substr(digits)) + 1));
}

TEST(CsvColumns, ColumnNamesAreDistinctAndInTheReadme) {
  const std::string readme = test::read_text(test::source_path("src/telemetry/README.md"));
  ASSERT_FALSE(readme.empty());
  for (const std::string& header :
       {csv_header(tick_columns()), csv_header(pose_columns()), csv_header(capture_columns())}) {
    const std::vector<std::string> names = split(header);
    const std::set<std::string> distinct(names.begin(), names.end());
    EXPECT_EQ(distinct.size(), names.size());
    EXPECT_EQ(names.front(), "t_s");
    for (const std::string& name : names) {
      if (in_the_middle_of_an_array(name, distinct)) continue;
      EXPECT_NE(readme.find("`" + name + "`"), std::string::npos) << name << " is not in the README";
    }
  }
}

}  // namespace
}  // namespace heel
