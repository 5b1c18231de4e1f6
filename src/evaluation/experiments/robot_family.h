// Every robot of the family, driven by heeld's own session and gate in virtual time: what its odometry says
// against the truth, and where it stops before a wall.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/config.h"
#include "evaluation/experiments/progress_callback.h"

namespace heel::evaluation {

struct FamilyDrive {
  std::string subclass;
  // On a floor and wheels without error: what is left is the error of units and track.
  double straight_truth_m = 0.0, straight_odometry_m = 0.0;
  double turn_truth_rad = 0.0, turn_odometry_rad = 0.0;
  double speed_truth_m_s = 0.0, speed_odometry_m_s = 0.0;  ///< while it drives straight
  // On an ordinary floor, straight towards a wall, at gate.v_max_m_s if the gate lets it:
  double wall_speed_m_s = 0.0;  ///< the largest
  double wall_gap_m = 0.0;      ///< from its front to the wall at the end; negative: it would have hit it
};

/// Throws heel::Error when the robot is not known, or is refused.
FamilyDrive drive_model(const std::string& subclass, const Config& config, std::uint64_t seed);

/// All that heel knows, in the order of robot_models(). `on_progress` counts robots.
std::vector<FamilyDrive> drive_family(const Config& config, std::uint64_t seed,
                                      const ProgressCallback& on_progress);

/// CSV, a row a robot.
void write_family(const std::vector<FamilyDrive>& drives, const std::string& path);
/// Markdown: a row a robot.
std::string family_table(const std::vector<FamilyDrive>& drives);

}  // namespace heel::evaluation
