// The status that an operator gets: what the newest tick says of robot, camera, target and limits, as JSON.
// Its fields are listed in docs/operator.md.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "heel/flow.h"
#include "operator/settings.h"

namespace heel {

struct StatusInput {
  TickRecord tick;
  bool any_tick = false;  ///< `tick` has a value
  CaptureCounters camera;
  TimeNs now_ns = 0;
};

/// The state and what it means, as {"state":…,"sentence":…}, for the answer to a command.
nlohmann::ordered_json state_json(const StatusInput& input);

/// All of the status; it begins with the fields of state_json().
nlohmann::ordered_json status_json(const StatusInput& input, const SettingsView& settings);

/// True: watchers get a line about the difference at once.
bool differs_to_a_watcher(const TickRecord& a, const TickRecord& b);

/// What the robot does and why, for people: "at rest: not started; `heel start` lets the robot move".
std::string sentence_of(const StatusInput& input);

/// {"key":…,"before":…,"after":…} for each.
nlohmann::ordered_json changes_json(const std::vector<ConfigChange>& changes);

}  // namespace heel
