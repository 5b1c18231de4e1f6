// How far, and how far turned, a taught shirt will be found by a camera: measured on pictures made from the
// template, by the same steps that search a frame of the robot.
//
// The made pictures show the back's average shape with folds that the template does not have, in front of
// grey texture, blurred by a lens and with the noise of a sensor. They have no shading, no motion blur, no
// arm before the back: the measured reach is that of a good room.
//
// Units: metres, radians.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "heel/camera_model.h"
#include "heel/shirt_template.h"
#include "heel/vision_config.h"

namespace heel {

/// The pictures of one distance and turn; a turn is measured to both sides.
struct ReachCell {
  double distance_m = 0.0;
  double turn_rad = 0.0;  ///< 0: facing away; never negative
  int pictures = 0;
  int found = 0;  ///< with certainty ≥ 0.1, less than 15° and 10 % of the distance from the truth

  bool all_found() const { return found == pictures; }
};

struct TemplateReach {
  std::vector<ReachCell> cells;  ///< in the order they were measured
  bool complete = false;         ///< false: `progress` stopped it

  /// Of the longest run of distances at which the back is always found, facing away; 0: none.
  double near_m = 0.0, far_m = 0.0;
  /// Largest turn at which the back was found in every picture at kTurnDistance_m; no value: not measured, or
  /// not found when facing away.
  std::optional<double> turn_rad;

  static constexpr double kTurnDistance_m = 2.0;
};

/// Called after each picture with the number of them measured and the largest number that there can be; false
/// ends the measurement.
using ReachProgress = std::function<bool(int done, int most)>;

/// `camera`: of the robot. Throws heel::Error when the template cannot be followed by it, or has no distance.
TemplateReach measure_reach(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config,
                            const ReachProgress& progress);

/// A warning, in one line, if the shirt is found less far, or less far turned, than usual; empty if not.
std::string reach_warning(const TemplateReach& reach);

}  // namespace heel
