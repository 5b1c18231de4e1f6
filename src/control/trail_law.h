// The control law "trail": the robot drives the path that the person walked, at the set distance measured
// along it.
//
// Along the trail, with s_p the arc length of the person and s_r that of the robot:
//
//   v = V + k_z (s_p − s_r − D),      V: the person's speed,
//
// so that there is no lag at constant speed. Across it, with e the robot's offset (left +), theta its heading
// against the trail's, and kappa the trail's curvature (C. Samson, "Control of chained systems: application
// to path following and time-varying point-stabilization of mobile robots", IEEE Trans. Automatic Control
// 40(1), 1995):
//
//   omega = v kappa cos(theta) / (1 − kappa e) − v e sin(theta) / (theta L²) − 2 zeta |v| theta / L
//
// Linearised, over the distance driven: e'' + (2 zeta / L) e' + e / L² = 0: stable for every speed, and the
// offset is gone after some L. A delay T between pose and motion costs the phase v T / L: the robot's pose is
// predicted over it.
//
// Which gives way. The person is to stay in the picture, and the robot on the trail. On an arc of radius R
// with the person D ahead, their bearing is about D / (2 R): in narrow bends, and when the person steps
// aside, both cannot be had. The picture comes first, because a person out of it is lost: the robot leaves
// the trail to the inner side of the bend until the bearing is within its limit (control/view_bounds.h), and
// the sonar gate keeps the last word. The shirt's yaw against the camera follows from both: it is D / R in a
// bend and passes 45° where R is smaller than 1.27 D, without anything that the robot could do but drive
// closer.
#pragma once

#include "control/detour.h"
#include "control/follow_law.h"
#include "control/trail.h"
#include "control/trail_search.h"
#include "estimate/target_measurement.h"

namespace heel {

class TrailLaw final : public FollowLaw {
 public:
  explicit TrailLaw(const Config& config) { reconfigure(config); }

  void reconfigure(const Config& config) override;
  void reset() override;
  bool may_search() const override { return control_.search_m_s > 0.0; }
  /// Zero when the target is not known.
  WantedVelocity velocity(const FollowInput& input) override;

 private:
  /// The parts of ControlConfig in use; without its text, so that reconfigure() does not allocate.
  struct Gains {
    double distance_1_s = 0.0;
    double deadband_m = 0.0;
    double beside_m = 0.0;  // set point, left +
    bool reverse = false;
    double bearing_max_rad = 0.0;
    double bearing_1_s = 0.0;
    double reach_m = 0.0;
    double smooth_m = 0.0;
    double delay_s = 0.0;
    double clearance_m = 0.0;
    double deceleration_m_s2 = 0.0;
    double v_max_m_s = 0.0;
    double search_m_s = 0.0;
    double nearest_m = 0.0;  // that the gate lets the robot come to the axis of the person
  };
  void extend_trail(const FollowInput& input, const Pose2& robot);
  void update_person_speed(const TargetState& target, double dt_s);
  double speed_m_s(const FollowInput& input) const;
  double yaw_rate_rad_s(const Pose2& robot, double v_m_s, double offset_m) const;
  double left_of_trail_m(const Pose2& robot) const;
  WantedVelocity search(const FollowInput& input, const Pose2& robot);

  Gains control_;
  CameraMount mount_;
  Trail trail_;
  Detour detour_;
  TrailSearch search_;
  double person_m_s_ = 0.0;  // along the trail, smoothed
  TimeNs t_last_ns_ = 0;
  double robot_s_m_ = 0.0;   // of the robot along the trail
  TimeNs t_capture_ns_ = 0;  // of the newest point
};

}  // namespace heel
