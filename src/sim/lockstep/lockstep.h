// The daemon's own stages in lock step with the simulated world, in virtual time:
//
//   World ─picture→ TemplateSelector ─(modelled latency)→ ControlStage ─command→ ArcosSession ─bytes→ P3At
//     ↑                                                    ↑ RobotState ──────────┘    ←bytes─┘   │
//     └──────────────────────────────── true pose of the robot ───────────────────────────────────┘
//
// With an error model, World renders nothing and SampledPoses takes TemplateSelector's place; all else is the
// same. Nothing here reads a clock: the same scenario, configuration and template give the same run to the
// bit.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/config.h"
#include "heel/flow.h"
#include "heel/shirt_template.h"
#include "sim/lockstep/simulated_operator.h"
#include "sim/pose_noise/error_model.h"
#include "sim/robot/p3at.h"
#include "sim/scene/scenario.h"
#include "sim/scene/world.h"

namespace heel::sim {

struct LockstepSettings {
  Scenario scenario;
  Config config;
  /// In the order of time. Without any, supervisor.start counts as at_once.
  std::vector<OperatorAction> operator_actions;
  ShirtTemplate shirt;                     ///< with `errors` only its distance is used
  std::vector<ShirtTemplate> more_shirts;  ///< further templates of the person: target.more_shirts
  /// Poses are sampled from this model, without pictures: about a hundred times faster, for statistics.
  std::optional<ErrorModel> errors;
};

/// The truth at one time. Without a world (frames from a file) there is only the robot's.
struct LockstepTruth {
  TimeNs t_ns = 0;
  RobotTruth robot;
  bool has_world = false;
  bool walking = false;
  Truth world;
};

/// The configuration that the control stage of a run gets.
Config control_config(const LockstepSettings& settings);

/// Receives what happens in a run, in the order of time.
class LockstepObserver {
 public:
  virtual ~LockstepObserver() = default;
  virtual void on_tick(const TickRecord& /*tick*/, const LockstepTruth& /*truth*/) {}
  /// `truth` is that of the capture time.
  virtual void on_pose(const FrameView& /*frame*/, const PoseEstimate& /*pose*/,
                       const LockstepTruth& /*truth*/) {}
  virtual void on_bytes_to_robot(std::span<const std::uint8_t> /*bytes*/, TimeNs /*t_ns*/) {}
  virtual void on_bytes_from_robot(std::span<const std::uint8_t> /*bytes*/, TimeNs /*t_ns*/) {}
};

/// Counts of a run.
struct LockstepCounts {
  std::uint64_t ticks = 0;
  std::uint64_t frames = 0;
  std::uint64_t frames_overtaken = 0;  ///< replaced by a newer frame while vision was busy
  std::uint64_t frames_dropped = 0;    ///< lost by the camera, as the scenario says
};

/// Runs the whole scenario. Throws heel::Error before it begins when something does not fit together.
LockstepCounts run_lockstep(const LockstepSettings& settings, LockstepObserver& observer);

/// The template as `heel teach` would make it from the world's reference view.
ShirtTemplate teach_from_world(const Scenario& scenario, double distance_m);

/// The configuration a scenario implies: camera and its mount as in the scenario.
void apply_scenario(const Scenario& scenario, Config& config);

/// The simulated robot as the scenario describes it.
P3AtSettings robot_settings(const Scenario& scenario);

}  // namespace heel::sim
