#include "vision/pose/yaw_filter.h"

#include <algorithm>
#include <cmath>

#include "core/angles.h"

namespace heel {
namespace {

constexpr TimeNs kMaxGap_ns = kNsPerS / 2;
// Times between frames are rounded to this: the jitter of a clock does not change the answer.
constexpr TimeNs kTimeStep_ns = kNsPerMs / 10;
// A person begins to turn within a stride: about 20 degrees a second within one second.
constexpr double kAcceleration_rad_s1_5 = 20.0 * kRadPerDeg;
constexpr double kStartRateSigma_rad_s = 30.0 * kRadPerDeg;
// The cloth of a walking person swings by this. Cloth that has settled again in the same posture changes the
// yaw by 4 degrees (root mean square): the picture of the teaching has as much of it as the frame, 3 degrees.
constexpr double kSwingSigma_rad = 5.0 * kRadPerDeg;
constexpr double kTeachingSigma_rad = 3.0 * kRadPerDeg;
// A frame farther away than this many standard deviations gets a larger variance, in proportion.
constexpr double kOutlierGate = 3.0;

}  // namespace

FilteredYaw YawFilter::start(TimeNs t_ns, double yaw_rad, double sigma_rad) {
  const double swing_rad = std::max(kSwingSigma_rad, sigma_rad);
  started_ = true;
  t_ns_ = t_ns;
  state_ = {yaw_rad, 0.0};
  P_ << swing_rad * swing_rad, 0.0, 0.0, kStartRateSigma_rad_s * kStartRateSigma_rad_s;
  return {yaw_rad, sigma_rad};
}

FilteredYaw YawFilter::update(TimeNs t_ns, double yaw_rad, double sigma_rad) {
  const TimeNs gap_ns = t_ns - t_ns_;
  if (!started_ || gap_ns <= 0 || gap_ns > kMaxGap_ns) return start(t_ns, yaw_rad, sigma_rad);
  t_ns_ = t_ns;

  const double dt_s = seconds_from_ns((gap_ns + kTimeStep_ns / 2) / kTimeStep_ns * kTimeStep_ns);
  Eigen::Matrix2d F, Q;
  F << 1.0, dt_s, 0.0, 1.0;
  Q << dt_s * dt_s * dt_s / 3.0, dt_s * dt_s / 2.0, dt_s * dt_s / 2.0, dt_s;
  state_ = F * state_;
  P_ = F * P_ * F.transpose() + kAcceleration_rad_s1_5 * kAcceleration_rad_s1_5 * Q;

  const double swing_rad = std::max(kSwingSigma_rad, sigma_rad);
  double noise_rad2 = swing_rad * swing_rad;
  const double innovation_rad = wrap_angle_rad(yaw_rad - state_(0));
  const double distance2 = innovation_rad * innovation_rad / (P_(0, 0) + noise_rad2);
  noise_rad2 *= std::max(1.0, distance2 / (kOutlierGate * kOutlierGate));
  const Eigen::Vector2d gain = P_.col(0) / (P_(0, 0) + noise_rad2);
  state_ += gain * innovation_rad;
  P_ -= gain * P_.row(0);
  state_(0) = wrap_angle_rad(state_(0));
  return {state_(0), std::sqrt(P_(0, 0) + kTeachingSigma_rad * kTeachingSigma_rad)};
}

}  // namespace heel
