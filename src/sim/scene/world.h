// The world of a scenario: renders what the camera sees, and gives the truth about people, camera and
// obstacles. World frame: x and y on the floor, z up. Camera frame: as everywhere in heel.
#pragma once

#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "heel/features.h"
#include "sim/render/exposure.h"
#include "sim/render/ray_table.h"
#include "sim/scene/ground.h"
#include "sim/scene/person.h"
#include "sim/scene/room.h"
#include "sim/scene/scenario.h"
#include "sim/scene/world_use.h"

namespace heel::sim {

class Renderer;

/// Where the robot is and how it moves at one moment; world frame.
struct RobotMotion {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
};

/// The motion `dt_s` later at the same speeds.
RobotMotion moved(const RobotMotion& robot, double dt_s);

/// The truth at one moment. Values in the camera frame are those that a perfect vision stage would report.
struct Truth {
  WalkState person;  ///< of the target, between the feet, world frame
  /// Heading of the back, world frame: the taught one, turned by the best rigid motion from the cloth of the
  /// reference view to the cloth now.
  double back_yaw_rad = 0.0;
  Eigen::Vector3d back_m{0, 0, 0};  ///< cloth in the middle of the back, world frame
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Vector3d back_in_camera_m{0, 0, 0};
  /// The best rigid motion from the cloth of the reference view to the cloth now, as
  /// PoseEstimate::R_cur_from_ref, and its yaw, as PoseEstimate::yaw_rad.
  Eigen::Matrix3d R_cur_from_ref = Eigen::Matrix3d::Identity();
  double yaw_rad = 0.0;
  Eigen::Vector2d back_px{
      0, 0};               ///< the middle of the back in the picture; valid when it is in front of the camera
  bool in_view = false;    ///< the middle of the back is in the picture and the back faces the camera
  bool occluded = false;   ///< an obstacle or a person hides the middle of the back
  GroundPose ground_pose;  ///< of the robot
  Exposure exposure;
};

/// The view that a template is made from: the person stands, the camera is level and square to the back.
struct ReferenceView {
  std::vector<std::uint8_t> grey;
  Region roi;
  double distance_m = 0.0;
};

/// A person and the path the person walks.
struct WalkingPerson {
  Person person;
  Walk walk;
  double walk_after_s = 0.0;  ///< start of the walk, after that of the target
};

class World {
 public:
  /// `threads` for rendering, the calling thread included; 0: one for each core, but at most four. The
  /// pictures do not depend on their number.
  explicit World(const Scenario& scenario, int threads = 0, WorldUse use = WorldUse::Rendering);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Scenario& scenario() const { return scenario_; }
  const Walk& walk() const { return people_.front().walk; }

  /// Sets when the target starts to walk; until then the target stands. This, truth() and render() may be
  /// called by different threads at the same time, render() by one of them.
  void start_walk(double t_s) { walk_start_s_ = t_s; }
  bool walking() const { return walk_start_s_ < kNever; }
  /// Everybody stands still for the next `dt_s`, in the posture of the moment; 0: they walk. The same
  /// threads.
  void hold_walk(double dt_s) {
    walk_held_ = dt_s > 0.0;
    walk_start_s_ = walk_start_s_ + dt_s;
  }

  Truth truth(const RobotMotion& robot, double t_s) const;
  /// The picture whose middle row's exposure is centred on `t_s`. Depends on the arguments and the scenario
  /// only. Needs WorldUse::Rendering.
  void render(const RobotMotion& robot, double t_s, std::uint64_t frame, std::vector<std::uint8_t>& grey);
  /// Needs WorldUse::Rendering. Throws heel::Error when the back does not fit into the picture.
  ReferenceView reference_view(double distance_m);

  /// The target alone in the room, in any pose and view, without motion and in full light. `frame` determines
  /// the noise. Needs WorldUse::Rendering.
  void draw_still(const PersonPose& target, const Eigen::Isometry3d& view_from_world, std::uint64_t frame,
                  std::vector<std::uint8_t>& grey);

  Eigen::Isometry3d world_from_camera(const RobotMotion& robot) const;
  /// Shutter time and gain of the picture at `t_s`.
  Exposure exposure(double t_s) const { return exposure_.at(t_s); }
  PersonPose person_pose(double t_s) const { return pose_of(0, t_s); }
  /// The target in the reference view.
  PersonPose taught_pose() const { return person().pose(scenario_.person_start, 0.0, kTaughtPosture); }
  const Person& person() const { return people_.front().person; }
  /// The target first, then the passers-by in the scenario's order.
  const std::deque<WalkingPerson>& people() const { return people_; }
  /// The pose of people()[index].
  PersonPose pose_of(std::size_t index, double t_s) const;
  /// Cloth in the middle of the back, world frame.
  Eigen::Vector3d back_m(const PersonPose& pose) const {
    return pose.world_from_part[kTorso] * person().torso().back_centre_m(pose.cloth);
  }
  /// The level camera of the reference view, square to the back.
  Eigen::Isometry3d reference_view_from_world(double distance_m) const;
  /// Points spread over the cloth of the target's back, world frame; the same points for every pose.
  std::vector<Eigen::Vector3d> back_points_m(const PersonPose& pose) const;
  const Room& room() const { return room_; }
  const Light& light() const { return light_; }

  /// Distorted pixel of a point in the camera frame; the point must lie in front of the camera.
  Eigen::Vector2d project_px(const Eigen::Vector3d& point_in_camera_m) const;
  /// The pixel at which the picture of middle time `t_s` shows a moving point, with the rolling shutter;
  /// `point_m` gives its place in the world. False when the point is behind the camera or far outside the
  /// picture.
  bool pixel_of_moving_point(const RobotMotion& robot, double t_s,
                             const std::function<Eigen::Vector3d(double t_s)>& point_m,
                             Eigen::Vector2d& px) const;

  /// The range of a sonar at a place on the floor with heading `heading_rad`: the distance to the nearest
  /// obstacle or person in its beam, infinity when there is none within kSonarReach_m. Surfaces reflect at
  /// every angle.
  double range_m(double x_m, double y_m, double heading_rad, double t_s) const;
  /// The people as obstacles for sonars and bumpers, the target first.
  std::vector<Footprint> people_footprints(double t_s) const;

 private:
  static constexpr double kSonarHalfBeam_rad = 0.26;
  static constexpr double kSonarReach_m = 5.0;
  static constexpr double kNever = 1e18;
  struct PixelBox {
    Eigen::Vector2d low, high;
  };
  PixelBox back_region_px(const Eigen::Isometry3d& view_from_torso, const ClothState& cloth) const;
  bool occluded(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& point_m, double t_s) const;

  Scenario scenario_;
  std::deque<WalkingPerson> people_;
  std::vector<Eigen::Vector3d> taught_back_m_;  ///< points of the target's cloth in the reference view, world
  Light light_;
  Room room_;
  Ground ground_;
  ExposureControl exposure_;
  std::atomic<double> walk_start_s_{kNever};  ///< set by one thread while another renders
  std::atomic<bool> walk_held_{false};
  RayBounds view_;
  std::unique_ptr<Renderer> renderer_;  ///< null with WorldUse::TruthOnly
};

}  // namespace heel::sim
