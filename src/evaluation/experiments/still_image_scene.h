// Pictures of a standing person from commanded poses, and what the daemon's vision stage estimates from them.
// The person stands at the origin and faces +x; the camera moves around, so that every pose has another
// background.
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

/// What differs between the worlds of one experiment.
struct StillImageWorld {
  std::uint64_t seed = 1;
  std::string shirt = "bold";
  double light = 1.0;  ///< sim::LightSettings::level; the template is made at 1

  // clang-tidy 14 takes the compiler's own comparison with 0 for ours. NOLINTNEXTLINE(modernize-use-nullptr)
  auto operator<=>(const StillImageWorld&) const = default;
};

/// The commanded pose and disturbances of one picture.
struct StillImageView {
  double x_m = 0.0;  ///< middle of the back, camera frame
  double z_m = 2.0;
  double yaw_rad = 0.0;   ///< as PoseEstimate::yaw_rad
  double blur_px = 0.0;   ///< length of the motion blur in the middle of the picture: the camera turns
  double occluded = 0.0;  ///< share of the back's width that a board hides, from its left; negative: right
};

/// One picture: commanded, true and estimated values.
struct StillImageRow {
  std::string name;  ///< of the case
  StillImageWorld world;
  StillImageView view;
  int picture = 0;  ///< 0: the whole frame was searched; 1: the next frame, tracked from the first
  double true_x_m = 0.0, true_y_m = 0.0, true_z_m = 0.0, true_yaw_rad = 0.0;
  Eigen::Vector3d true_t_m{0, 0, 0};  ///< of X_cur = R X_ref + t
  std::array<double, 3> t_m{};        ///< the estimate of t
  std::array<double, 3> t_sigma_m{};  ///< its stated standard deviation
  PoseEstimate pose;
  std::array<Eigen::Vector2d, 4> outline_px;  ///< corners of the template's region in the frame, distorted
  double vision_ms = 0.0;                     ///< processor time of the vision stage
};

class StillImageScene {
 public:
  /// Camera, sensor and light are those of `base`; its path and robot are not used. Throws heel::Error when
  /// the template `shirt` cannot be followed.
  StillImageScene(const sim::Scenario& base, const StillImageWorld& world, const ShirtTemplate& shirt,
                  const VisionConfig& vision);

  /// Two pictures in sequence: the whole first one is searched for the shirt, which is then tracked into the
  /// second.
  std::array<StillImageRow, 2> estimate_pair(const std::string& name, const StillImageView& view);
  /// The last picture.
  const std::vector<std::uint8_t>& grey() const { return grey_; }

 private:
  StillImageRow estimate(const std::string& name, const StillImageView& view, int picture);
  sim::Truth render(const StillImageView& view);
  void set_truth(const sim::Truth& truth, StillImageRow& row) const;
  void set_estimate(StillImageRow& row) const;

  StillImageWorld settings_;
  sim::World world_;
  ShirtTemplate shirt_;
  PoseTracker vision_;
  double t_s_ = 0.0;
  std::uint64_t frame_ = 0;
  std::vector<std::uint8_t> grey_;
};

/// `base` with the person standing in an open space.
sim::Scenario still_image_scenario(const sim::Scenario& base, const StillImageWorld& world);

/// The robot whose camera has the back at `view`; of the truth about the person, the place and heading of the
/// back are used.
sim::RobotMotion robot_for(const sim::ScenarioCamera& camera, const sim::Truth& person,
                           const StillImageView& view);

}  // namespace heel::evaluation
