// The direction in which a person walks, from the poses of their back in odom.
//
// The yaw of the shirt is not the direction of travel: hips and shoulders swing by 5 to 9° with each stride,
// the cloth moves over the back, and even the mean yaw of the back differs from the path's by some degrees.
// These errors are correlated over time. A filter that takes them for white noise states a deviation that is
// far too small. Here each of them is a state of its own, driven by white noise (Y. Bar-Shalom, X. Li,
// T. Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, sections 8.2 and 8.4).
// What they hide comes from the displacement: a person who walks forwards moves along their path.
//
//   state      meaning                                       changes by
//   p          axis of the body on the floor                 p' = v t(psi) + u n(psi)
//   v          speed forwards                                white acceleration
//   u          speed sideways: next to none in a walk,       fades with kSlipMemory
//              free when the person stands or walks back
//   psi        direction of travel                           psi' = omega
//   omega      its rate                                      fades with kTurnMemory
//   s, s*      swing of the back's yaw with the stride       damped oscillation at the rate of strides
//   y, y*      sway of the back to the side with the stride  damped oscillation at the rate of strides
//   a          mean yaw of the back against the path         fades with kBiasMemory
//   b          lasting error of vision (the taught cloth)    fades with kBiasMemory
//   c          passing error of vision, in stated sigmas     fades with kClothMemory
//   m1, m2, m3 psi through three equal low passes: m3 is the mean direction of travel over the last stride.
//              Frames during a turn correct it too, so that it is far better known than psi now.
//
//   measured position = p − l t(psi + s + a) + y n(psi)
//   measured yaw      = psi + s + a + b + sigma c
//   t(angle): unit vector in that direction; n: unit vector to its left; l: body axis to back
//
// The rate of strides follows from the speed, because step length over step rate is nearly the same for all
// speeds of a person (N. Sekiya, H. Nagasaki, "Reproducibility of the walking patterns of normal young
// adults", Gait & Posture 7, 1998). The filter is an extended Kalman filter (Bar-Shalom et al.,
// section 10.3.3).
//
// "Forwards" is where the chest points: of a person who steps aside or walks backwards the filter gives that.
// The estimated bias a + b is limited to three of its deviations: if the displacement disagrees with the back
// for a long time (side steps, odometry errors), psi moves away from the back by at most that angle.
#pragma once

#include <Eigen/Core>

namespace heel {

/// What one frame shows of the back; odom.
struct BackMeasurement {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d R_position = Eigen::Matrix2d::Identity();  ///< covariance, m²
  double yaw_rad = 0.0;
  double yaw_sigma_rad = 0.0;
};

/// An angle in odom, continuous over time.
struct DirectionEstimate {
  double angle_rad = 0.0;
  double sigma_rad = 0.0;  ///< one standard deviation
};

/// Does not allocate.
class TravelFilter {
 public:
  void start(const BackMeasurement& back);
  /// `acceleration_sigma_m_s2`: standard deviation of the change of speed in one second.
  void predict(double dt_s, double acceleration_sigma_m_s2);
  /// A yaw that is far off counts less.
  void correct(const BackMeasurement& back);

  /// Direction of travel `ahead_s` after the last prediction; mean yaw of the back while the person stands.
  DirectionEstimate travel(double ahead_s) const;
  /// Mean direction of travel over the stride before the last prediction.
  DirectionEstimate stride() const;
  double speed_m_s() const { return state_(kSpeed); }

  /// The walk at the last prediction, without sway and swing.
  struct Walk {
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< axis of the body, odom
    double position_sigma_m = 0.0;                         ///< of the less certain direction
    double forwards_m_s = 0.0, forwards_sigma_m_s = 0.0;
    double aside_m_s = 0.0;  ///< left +
    double turn_rad_s = 0.0, turn_sigma_rad_s = 0.0;
  };
  Walk walk() const;

 private:
  enum Index {
    kX,
    kY,
    kSpeed,
    kSlip,
    kPsi,
    kTurn,
    kSwing,
    kSwingQuadrature,
    kSway,
    kSwayQuadrature,
    kBackBias,
    kClothBias,
    kCloth,
    kMean1,
    kMean2,
    kMean3,
    kStates
  };
  using State = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;
  using Innovation = Eigen::Matrix<double, 3, 1>;
  using Observation = Eigen::Matrix<double, 3, kStates>;

  Matrix transition(double dt_s, const Eigen::Vector2d& t) const;
  void add_noise(double dt_s, const Eigen::Vector2d& t, const Matrix& F, double acceleration_sigma_m_s2);
  Innovation innovation(const BackMeasurement& back) const;
  Observation observation(const BackMeasurement& back) const;
  void limit_bias();

  State state_ = State::Zero();
  Matrix P_ = Matrix::Identity();
};

}  // namespace heel
