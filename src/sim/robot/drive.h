// The firmware's motion server: setpoints of translation and rotation by the motion commands, and the wheel
// speeds that follow under the limits of acceleration and speed. SI units; the commands' mm and degrees are
// converted where the commands are read.
#pragma once

#include "core/angles.h"
#include "sim/robot/axis_profile.h"
#include "sim/robot/chassis.h"

namespace heel::sim {

class Drive {
 public:
  Drive(const AxisLimits& translation_m, const AxisLimits& rotation_rad, double effective_track_m);

  AxisLimits translation_limits;  ///< m; changed by SETV, SETA
  AxisLimits rotation_limits;     ///< rad; changed by SETRV, SETRA

  // A setpoint is kept until it is replaced, also during a watchdog stop and while the motors are off.
  void set_speed(double v_m_s);                      ///< VEL
  void move(double distance_m, double travelled_m);  ///< MOVE, at the SETV speed
  void set_yaw_rate(double yaw_rate_rad_s);          ///< RVEL, ROTATE
  void turn_to(double heading_rad);                  ///< HEAD: in the shorter direction, odometry frame
  void set_wheels(const WheelSpeeds& wheels);        ///< VEL2: as translation and rotation
  void stop();                                       ///< STOP: with the set decelerations
  void emergency_stop();                             ///< E_STOP: as fast as motors and tyres can

  /// SETO: from now on headings are relative to the present one, `heading_rad`.
  void zero_heading(double heading_rad) { heading_setpoint_rad_ -= heading_rad; }

  struct Progress {
    double heading_rad = 0.0;  ///< by odometry
    double travelled_m = 0.0;  ///< along the path, backwards negative; never set to zero
  };
  /// One step. `stopped_by_watchdog`: the robot comes to rest, and the setpoints are kept.
  WheelSpeeds step(const Progress& now, bool stopped_by_watchdog, double dt_s);
  /// With the motors off, the profiles follow the wheels.
  void follow(const WheelSpeeds& wheels);

  /// The heading setpoint; the present heading while the robot turns at a set rate.
  double heading_setpoint_rad(double heading_rad) const {
    return holds_heading_ ? heading_setpoint_rad_ : heading_rad;
  }
  /// Direction of the translation setpoint: +1, −1 or 0.
  int direction(double travelled_m) const;
  /// Whether a setpoint is not reached yet: with power the wheels would turn.
  bool has_motion_to_do(const Progress& now) const;

 private:
  void step_translation(double travelled_m, bool stopped_by_watchdog, double dt_s);
  void step_rotation(double heading_rad, bool stopped_by_watchdog, double dt_s);

  double effective_track_m_;
  AxisProfile translation_;
  AxisProfile rotation_;

  double speed_setpoint_m_s_ = 0.0;
  bool moves_to_goal_ = false;  ///< by MOVE; otherwise at a set speed
  double goal_m_ = 0.0;         ///< in `travelled_m`

  double yaw_rate_setpoint_rad_s_ = 0.0;
  bool holds_heading_ = false;  ///< by HEAD, DHEAD or DCHEAD; otherwise at a set rate
  double heading_setpoint_rad_ = 0.0;
};

}  // namespace heel::sim
