// The pictured person at a commanded pose before the camera, and what the daemon's vision stage makes of the
// picture. The person stands at the origin, facing +x; the camera goes round them, so that every pose has a
// background of its own. All truth is the world's.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "heel/flow.h"
#include "heel/pose_tracker.h"
#include "heel/shirt_template.h"
#include "sim/scene/scenario.h"
#include "sim/scene/world.h"

namespace heel::evaluation {

/// What a world is made for.
struct StillSurroundings {
  std::uint64_t seed = 1;
  std::string shirt = "bold";
  double light = 1.0;  ///< sim::LightSettings::level while looking; the template is taught at 1

  auto operator<=>(const StillSurroundings&) const = default;
};

/// What is commanded.
struct StillView {
  double x_m = 0.0;  ///< middle of the back, camera frame
  double z_m = 2.0;
  double yaw_rad = 0.0;   ///< as PoseEstimate::yaw_rad
  double blur_px = 0.0;   ///< length of the sideways smear in the middle of the picture; the camera turns
  double occluded = 0.0;  ///< share of the back's width that a board hides, from its left; negative: right
};

/// One picture: commanded, true and estimated.
struct StillRow {
  std::string name;  ///< of the case
  StillSurroundings surroundings;
  StillView view;
  int picture = 0;  ///< 0: looked for in the whole frame; 1: the next frame, where the first one said
  double true_x_m = 0.0, true_y_m = 0.0, true_z_m = 0.0, true_yaw_rad = 0.0;
  Eigen::Vector3d true_t_m{0, 0, 0};  ///< of X_cur = R X_ref + t
  std::array<double, 3> t_m{};        ///< estimated, and its stated standard deviation
  std::array<double, 3> t_sigma_m{};
  PoseEstimate pose;
  std::array<Eigen::Vector2d, 4> outline_px;  ///< the template's region carried into the frame, distorted
  double vision_ms = 0.0;                     ///< processor time of the vision stage
};

class StillScene {
 public:
  /// Camera, sensor, person's build and light are those of `base`; its path and robot are not used.
  /// `shirt` is the template. Throws heel::Error where it cannot be followed.
  StillScene(const sim::Scenario& base, const StillSurroundings& surroundings, const ShirtTemplate& shirt,
             const VisionConfig& vision);

  /// Two pictures in a row: the shirt is looked for in the whole first one, then tracked into the second.
  std::array<StillRow, 2> look(const std::string& name, const StillView& view);
  /// The picture last looked at.
  const std::vector<std::uint8_t>& grey() const { return grey_; }

 private:
  StillRow look_once(const std::string& name, const StillView& view, int picture);

  StillSurroundings surroundings_;
  sim::World world_;
  ShirtTemplate shirt_;
  PoseTracker vision_;
  double t_s_ = 0.0;
  std::uint64_t frame_ = 0;
  std::vector<std::uint8_t> grey_;
};

/// `base` with the person standing in an open space, wearing `shirt`.
sim::Scenario still_scenario(const sim::Scenario& base, const StillSurroundings& surroundings);

/// The robot that has the back at `view` in its camera, the person standing at the origin and facing +x.
/// `back_m` is the middle of the back in the world.
sim::RobotMotion robot_for(const sim::ScenarioCamera& camera, const Eigen::Vector3d& back_m,
                           const StillView& view);

}  // namespace heel::evaluation
