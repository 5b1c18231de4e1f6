// The P3-AT's wheels, their odometry and the true motion.
//
// The wheels of a skid-steer robot slip in every turn. The firmware integrates the wheel travel with the
// effective track of DiffConvFactor (588 mm); the true track depends on the floor:
//   odometry   Δs = (l + r)/2,            Δθ = (r − l)/effective_track
//   truth      Δs = (l' + r')/2 + drift,  Δθ = (r' − l')/true_track,  l' = l (1 + left_scale_error) …
#pragma once

#include <cstdint>
#include <random>

#include "core/pose2.h"

namespace heel::sim {

struct ChassisSettings {
  double effective_track_m = 0.588;  ///< 2 / 0.0034: the track in the firmware's odometry
  double true_track_m = 0.62;        ///< of a P3-AT; depends on the floor, 0.55…0.70
  double track_scale = 1.0;          ///< of this robot's tracks to a P3-AT's
  double left_scale_error = -0.002;  ///< true travel / encoder travel − 1
  double right_scale_error = 0.002;  ///< a difference from the left one makes a straight drive curved
  double drift_per_sqrt_m = 0.0075;  ///< random walk along the path: 0.75 % after one metre, 1 σ
  double heading_drift_rad_per_sqrt_m = 0.003;  ///< random walk of the heading, 1 σ after one metre
  double wheel_acceleration_max_m_s2 = 6.0;     ///< limit of motors and tyres, above that of every profile
  double wheel_deceleration_max_m_s2 = 6.0;     ///< less: weak brakes, which no packet reports
  double coast_deceleration_m_s2 = 3.0;         ///< by the gears, with the motors off
};

/// No slip, no scale error, no drift: odometry is the truth.
ChassisSettings exact_chassis(ChassisSettings settings = {});

struct WheelSpeeds {
  double left_m_s = 0.0;
  double right_m_s = 0.0;
};

class Chassis {
 public:
  Chassis(const ChassisSettings& settings, std::uint64_t seed) : settings_(settings), random_(seed) {}

  /// One step with the motors driving the wheels to the speeds `target`. Blocked wheels do not move.
  void drive(const WheelSpeeds& target, double dt_s);
  /// One step with the motors off.
  void coast(double dt_s);
  void block(bool left, bool right);

  const WheelSpeeds& wheels() const { return wheels_; }
  const Pose2& odometry() const { return odometry_; }  ///< since the last zero_odometry()
  void zero_odometry() { odometry_ = Pose2{}; }
  double left_travel_m() const { return left_travel_m_; }  ///< by the encoder, since power-on
  double right_travel_m() const { return right_travel_m_; }

  const Pose2& true_pose() const { return true_pose_; }
  void place(const Pose2& pose) { true_pose_ = pose; }
  /// Changes the floor under the wheels.
  void set_true_track(double track_m) { settings_.true_track_m = track_m; }
  double true_speed_m_s() const;
  double true_yaw_rate_rad_s() const;

 private:
  double driven(double speed_m_s, double target_m_s, double dt_s) const;
  void move(double dt_s);

  ChassisSettings settings_;
  std::mt19937_64 random_;
  std::normal_distribution<double> gaussian_;
  WheelSpeeds wheels_;
  bool blocked_left_ = false;
  bool blocked_right_ = false;
  Pose2 odometry_;
  Pose2 true_pose_;
  double left_travel_m_ = 0.0;
  double right_travel_m_ = 0.0;
};

}  // namespace heel::sim
