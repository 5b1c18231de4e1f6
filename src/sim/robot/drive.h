// The firmware's motion server: what each motion command asks of translation and of rotation, and the wheel
// speeds that follow under the acceleration and speed limits. SI units; the commands' mm and degrees are
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

  // Setpoints stay until replaced: they outlive the watchdog's stop and motors switched off.
  void set_speed(double v_m_s);                      ///< VEL
  void move(double distance_m, double travelled_m);  ///< MOVE, at the SETV speed
  void set_yaw_rate(double yaw_rate_rad_s);          ///< RVEL, ROTATE
  void turn_to(double heading_rad);                  ///< HEAD: the shorter way, odometry frame
  void set_wheels(const WheelSpeeds& wheels);        ///< VEL2: as translation and rotation
  void stop();                                       ///< STOP: at the set decelerations
  void emergency_stop();                             ///< E_STOP: as fast as the tyres allow

  /// Headings are counted from the present one, `heading_rad`, from now on (SETO).
  void zero_heading(double heading_rad) { heading_setpoint_rad_ -= heading_rad; }

  /// What odometry says now. `travelled_m` counts along the path, backwards negative, never zeroed.
  struct Progress {
    double heading_rad = 0.0;
    double travelled_m = 0.0;
  };
  /// One step; `held`: the watchdog brings the robot to rest and keeps the setpoints.
  WheelSpeeds step(const Progress& now, bool held, double dt_s);
  /// Without power the profiles follow the wheels.
  void follow(const WheelSpeeds& wheels);

  /// Last setpoint of the heading; the present heading while turning by speed.
  double heading_setpoint_rad(double heading_rad) const {
    return holds_heading_ ? heading_setpoint_rad_ : heading_rad;
  }
  /// +1, −1 or 0: which way the translation setpoint goes.
  int direction(double travelled_m) const;
  /// A setpoint not yet reached: the wheels would turn if they might.
  bool asked_to_move(const Progress& now) const;

 private:
  void step_translation(double travelled_m, bool held, double dt_s);
  void step_rotation(double heading_rad, bool held, double dt_s);

  double effective_track_m_;
  AxisProfile translation_;
  AxisProfile rotation_;

  double speed_setpoint_m_s_ = 0.0;
  bool moves_to_goal_ = false;  ///< MOVE under way; otherwise by speed
  double goal_m_ = 0.0;         ///< in `travelled_m`

  double yaw_rate_setpoint_rad_s_ = 0.0;
  bool holds_heading_ = false;  ///< HEAD and its kin; otherwise by speed
  double heading_setpoint_rad_ = 0.0;
};

}  // namespace heel::sim
