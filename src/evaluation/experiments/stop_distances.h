// How far and how long the robot rolls from what stops it until it is at rest, measured in lock step: through
// the supervisor, the gate, the wire and the simulated robot's dynamics.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "evaluation/experiments/progress_callback.h"
#include "sim/pose_noise/error_model.h"

namespace heel::evaluation {

/// What stops the robot.
enum class StopTrigger : std::uint8_t {
  EStop,        ///< the operator's estop
  Stop,         ///< the operator's stop
  RobotSilent,  ///< no packet from the robot arrives any more; it still hears heeld
  LineCut,      ///< nothing passes in either direction: the robot's own watchdog stops it
};
inline constexpr StopTrigger kStopTriggers[] = {StopTrigger::EStop, StopTrigger::Stop,
                                                StopTrigger::RobotSilent, StopTrigger::LineCut};
std::string_view to_string(StopTrigger trigger);

/// One stop, by the truth.
struct StopDistance {
  StopTrigger trigger = StopTrigger::EStop;
  std::uint64_t seed = 0;
  double v_m_s = 0.0;       ///< when it was triggered
  double rest_s = 0.0;      ///< until the wheels stand
  double distance_m = 0.0;  ///< driven meanwhile
};

/// The speeds, in m/s, up to `gate.v_max_m_s`.
std::vector<double> stop_speeds_m_s(const Config& config);

/// Follows a person who walks at `v_m_s`, and stops. Throws heel::Error when the robot does not come to rest.
StopDistance measure_stop(StopTrigger trigger, double v_m_s, const Config& config,
                          const sim::ErrorModel& errors, std::uint64_t seed);

/// By each trigger at each of these speeds, with five seeds from `first_seed`. `on_progress` counts stops.
std::vector<StopDistance> measure_stops(const Config& config, const sim::ErrorModel& errors,
                                        std::uint64_t first_seed, const ProgressCallback& on_progress);

/// CSV, a row a stop.
void write_stop_distances(const std::vector<StopDistance>& stops, const std::string& path);
/// Markdown: a row a speed; the longest way of all seeds by each trigger, beside what the gate keeps free.
std::string stop_distance_table(const std::vector<StopDistance>& stops, const Config& config);

}  // namespace heel::evaluation
