// The world a scenario describes: it draws what the camera sees and tells what is true.
// World frame: the robot's and the person's floor, x and y, z up. Camera frame as everywhere in heel.
#pragma once

#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <vector>

#include "heel-sim/camera/rasteriser.h"
#include "heel-sim/camera/sensor.h"
#include "heel-sim/world/person.h"
#include "heel-sim/world/room.h"
#include "heel-sim/world/scenario.h"
#include "heel/features.h"

namespace heel::sim {

/// Where the robot is and how it moves, at the middle of an exposure; world frame.
struct RobotMotion {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
};

/// What is true at one moment. Camera-frame values are what a perfect vision stage would report.
struct Truth {
  WalkState person;                 ///< world frame, between the feet
  double back_yaw_rad = 0.0;        ///< the torso's heading, gait included; world frame
  Eigen::Vector3d back_m{0, 0, 0};  ///< middle of the back, world frame
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Vector3d back_in_camera_m{0, 0, 0};
  double yaw_rad = 0.0;           ///< the back's direction in the camera frame, as PoseEstimate::yaw_rad
  Eigen::Vector2d back_px{0, 0};  ///< distorted pixel of the middle of the back; valid when in front
  bool in_view = false;  ///< the middle of the back is in front of the camera, in the picture, not averted
};

/// The view a template is taught from: the person stands, the camera is level and square to the back.
struct ReferenceView {
  std::vector<std::uint8_t> grey;
  Region roi;
  double distance_m = 0.0;
};

class World {
 public:
  explicit World(const Scenario& scenario);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Scenario& scenario() const { return scenario_; }
  const Walk& walk() const { return walk_; }

  /// The person sets off at this time; until then they stand. This, truth() and one thread's render() may
  /// run side by side.
  void start_walk(double t_s) { walk_start_s_ = t_s; }
  bool walking() const { return walk_start_s_ < kNever; }

  Truth truth(const RobotMotion& robot, double t_s) const;
  /// The picture whose exposure is centred on `t_s`. A function of the arguments and the scenario only.
  void render(const RobotMotion& robot, double t_s, std::uint64_t frame, std::vector<std::uint8_t>& grey);
  ReferenceView reference_view(double distance_m);

  Eigen::Isometry3d world_from_camera(const RobotMotion& robot) const;
  PersonPose person_pose(double t_s) const;
  const Person& person() const { return person_; }
  /// Distorted pixel of a point in the camera frame; the point must lie in front of the camera.
  Eigen::Vector2d project_px(const Eigen::Vector3d& point_in_camera_m) const;

 private:
  static constexpr double kNever = 1e18;
  /// Camera and person at the beginning, middle and end of an exposure.
  struct Moment {
    Eigen::Isometry3d camera_from_world;
    PersonPose person;
  };

  Moment moment(const RobotMotion& robot, double t_s, double offset_s) const;
  void draw_room(const Eigen::Isometry3d& camera_from_world);
  void draw_person(const Moment& now);
  void draw_mesh(const Mesh& mesh, const Eigen::Isometry3d& world_from_body,
                 const Eigen::Isometry3d& camera_from_world, int body);
  void render(const Moment& before, const Moment& now, const Moment& after, std::uint64_t frame,
              std::vector<std::uint8_t>& grey);
  void measure_motion(const Moment& before, const Moment& now, const Moment& after);

  Scenario scenario_;
  Walk walk_;
  Light light_;
  Person person_;
  Room room_;
  RayTable rays_;
  Rasteriser rasteriser_;
  Sensor sensor_;
  std::atomic<double> walk_start_s_{kNever};  ///< set by one thread while another draws
  std::vector<float> radiance_;
  MotionField motion_;
};

}  // namespace heel::sim
