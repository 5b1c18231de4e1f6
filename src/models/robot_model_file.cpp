#include "models/robot_model_file.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "toml/toml_file.h"
#include "toml/toml_section.h"

namespace heel {
namespace {

constexpr NumberRange kLength_mm{1, 3000, "mm"};
constexpr NumberRange kFactor{0.001, 100, ""};
constexpr double kTrackAgrees_mm = 1.0;
constexpr double kWidthAgrees_mm = 3.0;

double metres(double mm) {
  return mm / 1000.0;
}

void read_units(TomlSection units, RobotModel& model) {
  model.mm_per_position_unit = units.required_number("dist_conv", kFactor);
  model.mm_s_per_speed_unit = units.required_number("vel_conv", kFactor);
  model.mm_per_range_unit = units.required_number("range_conv", kFactor);
  model.heading_units_per_turn =
      static_cast<int>(units.required_number("heading_units_per_turn", {256, 65536, ""}));
  const double diff_conv = units.required_number("diff_conv", kFactor);
  const double track_mm = units.required_number("effective_track_mm", kLength_mm);
  if (std::abs(track_mm - 2.0 / diff_conv) > kTrackAgrees_mm)
    units.fail("effective_track_mm",
               fmt::format("{} (expected 2 / diff_conv, {:.1f})", track_mm, 2.0 / diff_conv));
  model.effective_track_m = metres(track_mm);
  units.reject_unknown_keys();
}

void read_limits(TomlSection limits, RobotModel& model) {
  model.v_max_mm_s = static_cast<int>(limits.required_number("v_max_mm_s", {1, 10000, "mm/s"}));
  model.yaw_rate_max_deg_s =
      static_cast<int>(limits.required_number("yaw_rate_max_deg_s", {1, 1000, "deg/s"}));
  limits.reject_unknown_keys();
}

void read_outline(TomlSection outline, RobotModel& model) {
  const double width_mm = outline.required_number("width_mm", kLength_mm);
  const double length_mm = outline.required_number("length_mm", kLength_mm);
  const double front_mm = outline.required_number("front_mm", kLength_mm);
  const double rear_mm = outline.required_number("rear_mm", kLength_mm);
  const double half_width_mm = outline.required_number("half_width_mm", kLength_mm);
  model.radius_m = metres(outline.required_number("radius_mm", kLength_mm));
  if (front_mm + rear_mm < length_mm)
    outline.fail("front_mm", fmt::format("{} and rear_mm {} (expected at least length_mm, {}, together)",
                                         front_mm, rear_mm, length_mm));
  if (std::abs(half_width_mm - 0.5 * width_mm) > kWidthAgrees_mm)
    outline.fail("half_width_mm",
                 fmt::format("{} (expected half of width_mm, {})", half_width_mm, 0.5 * width_mm));
  model.width_m = metres(width_mm);
  model.length_m = metres(length_mm);
  model.geometry.front_m = metres(front_mm);
  model.geometry.rear_m = metres(rear_mm);
  model.geometry.half_width_m = metres(half_width_mm);
  outline.reject_unknown_keys();
}

void read_sonars(TomlSection sonar, RobotModel& model) {
  RobotGeometry& geometry = model.geometry;
  for (const std::vector<double>& place : sonar.rows("places", 4)) {
    const double number = place[0];
    if (number < 0 || number >= static_cast<double>(kMaxSonars) || number != std::floor(number))
      sonar.fail("places", fmt::format("sonar {} (expected a whole number 0…{})", number, kMaxSonars - 1));
    const auto i = static_cast<std::size_t>(number);
    if (geometry.has_sonar(i)) sonar.fail("places", fmt::format("sonar {} twice (expected once)", i));
    geometry.sonars[i] = {metres(place[1]), metres(place[2]), place[3] * std::numbers::pi / 180.0};
    geometry.fitted |= 1u << i;
    if (place[1] > 0.0 && std::abs(place[3]) <= 90.0) geometry.ahead |= 1u << i;
  }
  if (geometry.ahead == 0) sonar.fail("places", "no sonar that looks ahead (expected at least one)");
  sonar.reject_unknown_keys();
}

}  // namespace

RobotModel parse_robot_model(std::string_view text, const std::string& file) {
  const toml::table table = parse_toml(text, file);
  TomlSection root(table, "", file);
  RobotModel model;
  model.subclass = root.text("subclass", "");
  if (model.subclass.empty()) root.fail("subclass", "missing (expected the name that the robot reports)");
  read_units(root.section("units"), model);
  read_limits(root.section("limits"), model);
  read_outline(root.section("outline"), model);
  read_sonars(root.section("sonar"), model);
  root.reject_unknown_keys();
  return model;
}

}  // namespace heel
