// Two control laws that command velocities in proportion to errors: "view", the paper's, and "position", a
// base line that does not depend on which way the person faces.
//
// "view" (M. Burke, W. Brink, "Estimating Target Orientation with a Single Camera for Use in a
// Human-Following Robot", PRASA 2010, section IV), written in the robot frame: the goal (g_x, g_y) is where
// the robot's centre has the reference view, and psi is the heading to have there (counter-clockwise +): the
// direction of travel, because the yaw of the back itself would turn the robot from side to side with each
// stride. The errors in the image are t_z = g_x, t_x = −g_y, yaw = −psi, and
//
//   v     = k_z g_x
//   omega = −k_x t_x − k_yaw yaw = k_x g_y + k_yaw psi
//
// "position" is the same with k_yaw = k_x d, where the goal is d behind the person. The person is at y = g_y
// + d sin(psi), so that psi cancels to third order: omega = k_x (g_y + d psi) ≈ k_x y turns towards the
// person and cuts every bend.
//
// Which k_yaw makes "view" walk round a bend on the person's own path follows from the bend. With the robot D
// behind the person's back on the same arc of radius R, and the axis of the body, whose direction of travel
// is estimated, l ahead of the back: psi = (D + l)/R and g_y = D²/(2R) − d psi, and omega must be V/R:
//
//   k_yaw = (V − k_x D²/2)/(D + l) + k_x d
//
// for every R. The default is that value for k_x = 1, l = 0.12 m, a template taken at 1.5 m and a fast 0.5
// m/s (robot's centre to back: d = 1.65 m, and with the lag V / k_z, D = 2.2 m).
//
// Stability, linearised about a person who walks straight at V, with the robot on their line at heading error
// theta and offset e (left +). In steady state v = V, so that the goal is G = V / k_z ahead, and
//
//   g_y = −e − G theta,  psi = −theta:     e' = V theta,   theta' = −k_x e − (k_yaw + k_x G) theta
//   s² + (k_yaw + k_x V / k_z) s + k_x V = 0
//
// Both coefficients are positive for positive gains and V > 0: stable, with natural frequency sqrt(k_x V) and
// damping (k_yaw + k_x V / k_z) / (2 sqrt(k_x V)), 0.9 or more for the default gains at any speed. A delay T
// in the loop costs the phase (k_yaw + k_x V / k_z) T at the crossover frequency: keep it below 1 rad, i.e. T
// < 0.7 s for the defaults at 0.5 m/s. At V = 0 a unicycle cannot remove the offset; the heading settles
// where k_x g_y = −k_yaw psi.
//
// Two bounds hold for all gains:
// · bearing: the person stays in the picture (control/view_bounds.h).
// · no reverse unless it is allowed.
#pragma once

#include "control/follow_law.h"
#include "estimate/target_measurement.h"

namespace heel {

/// Where k_yaw comes from.
enum class YawGain : std::uint8_t {
  FromConfiguration,  ///< control.gain_yaw_1_s: the law "view"
  CancelsYaw,         ///< k_x d: the law "position"
};

class ProportionalLaw final : public FollowLaw {
 public:
  ProportionalLaw(const Config& config, YawGain yaw_gain);

  void reconfigure(const Config& config) override;
  void reset() override {}  // it keeps no state
  /// Zero when the target is not known.
  WantedVelocity velocity(const FollowInput& input) override;

 private:
  struct Gains {
    double distance_1_s = 0.0;     // k_z
    double lateral_rad_s_m = 0.0;  // k_x
    double yaw_1_s = 0.0;          // k_yaw of "view"
    double setpoint_yaw_rad = 0.0;
    double deadband_distance_m = 0.0;
    bool reverse = false;
    double bearing_max_rad = 0.0;
    double bearing_1_s = 0.0;
  };
  double speed_m_s(const TargetState& target) const;
  double proportional_yaw_rate_rad_s(const TargetState& target) const;

  YawGain yaw_gain_;
  Gains gains_;
  CameraMount mount_;
};

}  // namespace heel
