// The sections [person] and [[passerby]]: walks and clothes.
#include <cmath>

#include "heel/error.h"
#include "sim/scene/scenario_parts.h"

namespace heel::sim {
namespace {

constexpr NumberRange kLength{0, 1000, "m"};

/// Reads the keys of one kind of step; false when there is no such kind.
bool read_step(const std::string& step, TomlSection& item, WalkItem& out) {
  if (step == "straight" || step == "back") {
    out.step = step == "back" ? WalkStep::Back : WalkStep::Straight;
    out.length_m = item.required_number("length_m", kLength);
  } else if (step == "aside") {
    out.step = WalkStep::Aside;
    out.length_m = item.required_number("left_m", {-100, 100, "m"});
  } else if (step == "arc") {
    out.step = WalkStep::Arc;
    out.radius_m = item.required_number("radius_m", {0.2, 1000, "m"});
    out.angle_rad = kRadPerDeg * item.required_number("angle_deg", kTurn_deg);
  } else if (step == "to") {
    out.step = WalkStep::To;
    out.x_m = item.required_number("x_m", kMetres);
    out.y_m = item.required_number("y_m", kMetres);
    out.radius_m = item.number("radius_m", out.radius_m, {0.2, 1000, "m"});
  } else if (step == "pause") {
    out.step = WalkStep::Pause;
    out.duration_s = item.required_number("duration_s", {0, 3600, "s"});
  } else if (step == "turn") {
    out.step = WalkStep::Turn;
    out.angle_rad = kRadPerDeg * item.required_number("angle_deg", kTurn_deg);
    out.duration_s = item.required_number("duration_s", {0.1, 3600, "s"});
  } else if (step == "sit") {
    out.step = WalkStep::Sit;
    out.duration_s = item.required_number("duration_s", {4, 3600, "s"});
  } else {
    return false;
  }
  return true;
}

WalkItem read_walk_item(TomlSection& item) {
  WalkItem out;
  const std::string step = item.text("step", "");
  if (!read_step(step, item, out))
    item.fail("step", "'" + step + "' (expected straight, arc, to, pause, turn, aside, back or sit)");
  const bool moves = out.step != WalkStep::Pause && out.step != WalkStep::Turn && out.step != WalkStep::Sit;
  if (moves) out.speed_m_s = item.number("speed_m_s", out.speed_m_s, {0.05, 3, "m/s"});
  item.reject_unknown_keys();
  return out;
}

std::vector<WalkItem> read_path(TomlSection& person) {
  std::vector<WalkItem> path;
  for (TomlSection& item : person.sections("path")) path.push_back(read_walk_item(item));
  return path;
}

WalkState read_start(TomlSection& person) {
  WalkState start;
  start.x_m = person.number("x_m", 0.0, kMetres);
  start.y_m = person.number("y_m", 0.0, kMetres);
  start.heading_rad = kRadPerDeg * person.number("heading_deg", 0.0, kTurn_deg);
  return start;
}

void read_body(TomlSection& person, PersonSettings& p) {
  try {
    p.hair = hair_style(person.text("hair", "short"));
  } catch (const Error& error) {
    person.fail("hair", error.what());
  }
  p.sway_yaw_rad = kRadPerDeg * person.number("sway_yaw_deg", p.sway_yaw_rad / kRadPerDeg, {0, 30, "deg"});
  p.hips_yaw_rad = kRadPerDeg * person.number("hips_yaw_deg", p.hips_yaw_rad / kRadPerDeg, {0, 30, "deg"});
  p.sway_side_m = person.number("sway_side_m", p.sway_side_m, {0, 0.2, "m"});
  p.sway_roll_rad = kRadPerDeg * person.number("sway_roll_deg", p.sway_roll_rad / kRadPerDeg, {0, 20, "deg"});
  p.bob_m = person.number("bob_m", p.bob_m, {0, 0.1, "m"});
  p.lean_rad = kRadPerDeg * person.number("lean_deg", p.lean_rad / kRadPerDeg, {-20, 30, "deg"});
  p.depth = person.number("depth", p.depth, {0.6, 1.6, ""});
  p.cloth_fold_m = person.number("cloth_fold_m", p.cloth_fold_m, {0, 0.02, "m"});
  p.cloth_fold_walking_m = person.number("cloth_fold_walking_m", p.cloth_fold_walking_m, {0, 0.03, "m"});
  p.cloth_pull_walking_m = person.number("cloth_pull_walking_m", p.cloth_pull_walking_m, {0, 0.03, "m"});
  p.cloth_slide_m = person.number("cloth_slide_m", p.cloth_slide_m, {0, 0.05, "m"});
  p.breath_m = person.number("breath_m", p.breath_m, {0, 0.02, "m"});
}

ShirtDesign read_shirt(TomlSection& person, const std::string& shirt) {
  try {
    return shirt_design(shirt);
  } catch (const Error& error) {
    person.fail("shirt", error.what());
  }
}

}  // namespace

void read_target(TomlSection person, Scenario& scenario) {
  scenario.person.shirt = read_shirt(person, person.text("shirt", "bold"));
  scenario.person_start = read_start(person);
  read_body(person, scenario.person);
  scenario.walk_after_s = person.number("walk_after_s", scenario.walk_after_s, {0, 3600, "s"});
  scenario.waits_beyond_m = person.number("waits_beyond_m", scenario.waits_beyond_m, {0, 100, "m"});
  scenario.path = read_path(person);
  person.reject_unknown_keys();
}

PasserbySettings read_passerby(TomlSection passerby) {
  PasserbySettings out;
  const std::string shirt = passerby.text("shirt", "mosaic");
  if (shirt == "same")
    out.shirt_origin = ShirtOrigin::Same;
  else if (shirt == "same_colours")
    out.shirt_origin = ShirtOrigin::SameColours;
  else
    out.person.shirt = read_shirt(passerby, shirt);
  out.start = read_start(passerby);
  read_body(passerby, out.person);
  out.walk_after_s = passerby.number("walk_after_s", 0.0, {-3600, 3600, "s"});
  out.path = read_path(passerby);
  passerby.reject_unknown_keys();
  return out;
}

}  // namespace heel::sim
