// The world a scenario describes: it draws what the camera sees and tells what is true.
// World frame: the robot's and the person's floor, x and y, z up. Camera frame as everywhere in heel.
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
#include "sim/scene/detail.h"
#include "sim/scene/ground.h"
#include "sim/scene/person.h"
#include "sim/scene/room.h"
#include "sim/scene/scenario.h"

namespace heel::sim {

class Renderer;

/// Where the robot is and how it moves, at the middle of an exposure; world frame.
struct RobotMotion {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
};

/// Carried on for `dt_s` at the same speed.
RobotMotion moved(const RobotMotion& robot, double dt_s);

/// What is true at one moment. Camera-frame values are what a perfect vision stage would report.
struct Truth {
  WalkState person;                 ///< world frame, between the feet
  double back_yaw_rad = 0.0;        ///< the torso's heading, gait included; world frame
  Eigen::Vector3d back_m{0, 0, 0};  ///< middle of the back, world frame
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Vector3d back_in_camera_m{0, 0, 0};
  double yaw_rad = 0.0;           ///< the back's direction in the camera frame, as PoseEstimate::yaw_rad
  Eigen::Vector2d back_px{0, 0};  ///< where the picture shows the middle of the back; valid when in front
  bool in_view = false;   ///< the middle of the back is in front of the camera, in the picture, not averted
  bool occluded = false;  ///< something or somebody stands before the middle of the back
  Stand stand;            ///< of the robot on the ground
  Exposure exposure;
};

/// The view a template is taught from: the person stands, the camera is level and square to the back.
struct ReferenceView {
  std::vector<std::uint8_t> grey;
  Region roi;
  double distance_m = 0.0;
};

/// Everybody is somewhere: the target first, then the passers-by in the scenario's order.
struct Figure {
  Person person;
  Walk walk;
  double walk_after_s = 0.0;  ///< after the target set off
};

class World {
 public:
  /// `threads` draw, the caller among them; 0: as many as there are cores, four at most. The pictures do not
  /// depend on it.
  explicit World(const Scenario& scenario, int threads = 0, Detail detail = Detail::Pictures);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Scenario& scenario() const { return scenario_; }
  const Walk& walk() const { return figures_.front().walk; }

  /// The person sets off at this time; until then they stand. This, truth() and one thread's render() may
  /// run side by side.
  void start_walk(double t_s) { walk_start_s_ = t_s; }
  bool walking() const { return walk_start_s_ < kNever; }

  Truth truth(const RobotMotion& robot, double t_s) const;
  /// Of a world made with Detail::Pictures. The picture whose middle row's exposure is centred on `t_s`. A
  /// function of the arguments and the scenario only.
  void render(const RobotMotion& robot, double t_s, std::uint64_t frame, std::vector<std::uint8_t>& grey);
  ReferenceView reference_view(double distance_m);  ///< likewise

  Eigen::Isometry3d world_from_camera(const RobotMotion& robot) const;
  /// Shutter time and gain of the picture at `t_s`.
  Exposure exposure(double t_s) const { return exposure_.at(t_s); }
  PersonPose person_pose(double t_s) const { return figure_pose(0, t_s); }
  const Person& person() const { return figures_.front().person; }
  const std::deque<Figure>& figures() const { return figures_; }
  PersonPose figure_pose(std::size_t figure, double t_s) const;
  const Room& room() const { return room_; }
  const Light& light() const { return light_; }

  /// Distorted pixel of a point in the camera frame; the point must lie in front of the camera.
  Eigen::Vector2d project_px(const Eigen::Vector3d& point_in_camera_m) const;
  /// Where the picture of middle time `t_s` shows a moving point (its place in the world over time), rolling
  /// shutter included. Points behind the camera have no place: false.
  bool seen_px(const RobotMotion& robot, double t_s,
               const std::function<Eigen::Vector3d(double t_s)>& point_m, Eigen::Vector2d& px) const;

  /// What a sonar at a place on the floor, heading `heading_rad`, hears: the distance to the nearest thing in
  /// its beam, people included, infinity when there is none within kSonarReach_m. SonarObstacles that glance
  /// off are heard as well.
  double range_m(double x_m, double y_m, double heading_rad, double t_s) const;
  /// Everybody as sonars and bumpers meet them, the target first.
  std::vector<Footprint> people_footprints(double t_s) const;

 private:
  static constexpr double kSonarHalfBeam_rad = 0.26;
  static constexpr double kSonarReach_m = 5.0;
  static constexpr double kNever = 1e18;
  bool occluded(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& point_m, double t_s) const;

  Scenario scenario_;
  std::deque<Figure> figures_;
  Light light_;
  Room room_;
  Ground ground_;
  ExposureControl exposure_;
  std::atomic<double> walk_start_s_{kNever};  ///< set by one thread while another draws
  RayBounds view_;
  std::unique_ptr<Renderer> renderer_;  ///< none without pictures
};

}  // namespace heel::sim
