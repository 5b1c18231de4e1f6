#include "estimate/travel_filter.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/angles.h"

namespace heel {
namespace {

// Of a person seen for the first time.
constexpr double kUnknownSpeedSigma_m_s = 1.0;
// People turn by up to 0.6 rad/s in a walk, for one to three seconds.
constexpr double kTurnSigma_rad_s = 0.33;
constexpr double kTurnMemory_s = 1.5;
// An amplitude of 5 to 9° is a deviation of 3.5 to 6.4°, of 2 to 5 cm one of 1.4 to 3.5 cm.
constexpr double kSwingSigma_rad = 4.5 * kRadPerDeg;
constexpr double kSwaySigma_m = 0.025;
// The swing keeps its phase for some strides; the rate of strides is known to a sixth.
constexpr double kGaitMemory_s = 4.0;
constexpr double kFullGait_m_s = 0.4;  // slower walks swing less
// Walk ratio: a speed of v has 1.69 sqrt(v) steps a second.
constexpr double kStepsPerSecond = 1.69;
constexpr double kSlowestGait_m_s = 0.2;
constexpr double kFastestGait_m_s = 2.0;
constexpr double kBackBiasSigma_rad = 2.0 * kRadPerDeg;
constexpr double kClothBiasSigma_rad = 1.5 * kRadPerDeg;
constexpr double kBiasMemory_s = 40.0;
// Farther off than three deviations of both, the back does not point along the path: the person does not walk
// forwards.
constexpr double kBiasLimit_rad = 7.5 * kRadPerDeg;
// Vision's errors in a walk: correlation 0.6 after 67 ms.
constexpr double kClothMemory_s = 0.13;
constexpr double kYawNoise_rad = 0.7 * kRadPerDeg;
constexpr double kBackBehindAxis_m = 0.12;
constexpr double kSlipMemory_s = 0.15;
constexpr double kWalkingSlipSigma_m_s = 0.017;
constexpr double kStandingSlipSigma_m_s = 0.4;
constexpr double kSlipSpeed_m_s =
    0.25;  // a person who walks faster than about twice this does not step aside
// The mean over the last stride: three low passes have the delay and the spread of a mean over 1.2 s.
constexpr double kStride_s = 1.2;
constexpr double kMeanMemory_s = kStride_s / 6.0;
constexpr double kFarOff = 3.0;  // in standard deviations

double square(double value) {
  return value * value;
}

Eigen::Vector2d unit(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

Eigen::Vector2d left_of(const Eigen::Vector2d& direction) {
  return {-direction.y(), direction.x()};
}

double stride_rate_rad_s(double speed_m_s) {
  return std::numbers::pi * kStepsPerSecond *
         std::sqrt(std::clamp(speed_m_s, kSlowestGait_m_s, kFastestGait_m_s));
}

/// 0 for a person who stands or walks backwards, 1 for one who walks.
double gait(double speed_m_s) {
  return std::clamp(speed_m_s / kFullGait_m_s, 0.0, 1.0);
}

double slip_sigma_m_s(double speed_m_s) {
  const double forwards = std::max(speed_m_s, 0.0) / kSlipSpeed_m_s;
  return std::hypot(kWalkingSlipSigma_m_s, kStandingSlipSigma_m_s * std::exp(-square(forwards)));
}

/// How long a turn lasts that begins at the rate omega, as a time at that rate.
double turning_s(double dt_s) {
  return kTurnMemory_s * (1.0 - std::exp(-dt_s / kTurnMemory_s));
}

/// Density of the white noise that drives omega.
constexpr double kTurnDensity = 2.0 * kTurnSigma_rad_s * kTurnSigma_rad_s / kTurnMemory_s;

}  // namespace

void TravelFilter::start(const BackMeasurement& back) {
  state_.setZero();
  state_.head<2>() = back.position_m + kBackBehindAxis_m * unit(back.yaw_rad);
  P_.setZero();
  P_.topLeftCorner<2, 2>() = back.R_position;
  P_(kSpeed, kSpeed) = square(kUnknownSpeedSigma_m_s);
  P_(kSlip, kSlip) = square(slip_sigma_m_s(0.0));
  P_(kTurn, kTurn) = square(kTurnSigma_rad_s);
  P_(kSwing, kSwing) = P_(kSwingQuadrature, kSwingQuadrature) = square(kSwingSigma_rad);
  P_(kSway, kSway) = P_(kSwayQuadrature, kSwayQuadrature) = square(kSwaySigma_m);
  P_(kBackBias, kBackBias) = square(kBackBiasSigma_rad);
  P_(kClothBias, kClothBias) = square(kClothBiasSigma_rad);
  P_(kCloth, kCloth) = 1.0;
  // psi = measured − (s + a + b + sigma c) − noise: its error is the sum of theirs. The means start as psi.
  State parts = State::Zero();
  parts(kSwing) = parts(kBackBias) = parts(kClothBias) = 1.0;
  parts(kCloth) = back.yaw_sigma_rad;
  const State covariance = -(P_ * parts);
  const double variance = parts.dot(P_ * parts) + square(kYawNoise_rad);
  constexpr std::array kDirections{kPsi, kMean1, kMean2, kMean3};
  for (const Index i : kDirections) {
    state_(i) = back.yaw_rad;
    P_.row(i) = covariance.transpose();
    P_.col(i) = covariance;
  }
  for (const Index i : kDirections)
    for (const Index j : kDirections) P_(i, j) = variance;
}

void TravelFilter::predict(double dt_s, double acceleration_sigma_m_s2) {
  const Eigen::Vector2d t = unit(state_(kPsi) + 0.5 * turning_s(dt_s) * state_(kTurn));
  const Matrix F = transition(dt_s, t);
  // Only the position depends on other states in a curve.
  const Eigen::Vector2d position_m =
      state_.head<2>() + dt_s * (state_(kSpeed) * t + state_(kSlip) * left_of(t));
  add_noise(dt_s, t, F, acceleration_sigma_m_s2);
  state_ = (F * state_).eval();
  state_.head<2>() = position_m;
}

/// Jacobian of the motion over `dt_s` in the mean direction `t`.
TravelFilter::Matrix TravelFilter::transition(double dt_s, const Eigen::Vector2d& t) const {
  const Eigen::Vector2d n = left_of(t);
  Matrix F = Matrix::Identity();
  F.block<2, 1>(kX, kSpeed) = dt_s * t;
  F.block<2, 1>(kX, kSlip) = dt_s * n;
  F.block<2, 1>(kX, kPsi) = dt_s * (state_(kSpeed) * n - state_(kSlip) * t);
  F.block<2, 1>(kX, kTurn) = 0.5 * turning_s(dt_s) * F.block<2, 1>(kX, kPsi);
  F(kSlip, kSlip) = std::exp(-dt_s / kSlipMemory_s);
  F(kPsi, kTurn) = turning_s(dt_s);
  F(kTurn, kTurn) = std::exp(-dt_s / kTurnMemory_s);

  const double phase_rad = stride_rate_rad_s(state_(kSpeed)) * dt_s;
  const double fade = std::exp(-dt_s / kGaitMemory_s);
  Eigen::Matrix2d oscillation;
  oscillation << std::cos(phase_rad), std::sin(phase_rad), -std::sin(phase_rad), std::cos(phase_rad);
  F.block<2, 2>(kSwing, kSwing) = F.block<2, 2>(kSway, kSway) = fade * oscillation;

  F(kBackBias, kBackBias) = F(kClothBias, kClothBias) = std::exp(-dt_s / kBiasMemory_s);
  F(kCloth, kCloth) = std::exp(-dt_s / kClothMemory_s);

  // Three low passes in a row, exact for a direction that stays at its middle value during dt.
  const double x = dt_s / kMeanMemory_s;
  const double e = std::exp(-x);
  F.block<3, 3>(kMean1, kMean1) << e, 0, 0,  //
      x * e, e, 0,                           //
      0.5 * x * x * e, x * e, e;
  F.block<3, 1>(kMean1, kPsi) =
      Eigen::Vector3d::Ones() - F.block<3, 3>(kMean1, kMean1) * Eigen::Vector3d::Ones();
  F.block<3, 1>(kMean1, kTurn) = 0.5 * turning_s(dt_s) * F.block<3, 1>(kMean1, kPsi);
  return F;
}

/// P = F P Fᵀ + Q.
void TravelFilter::add_noise(double dt_s, const Eigen::Vector2d& t, const Matrix& F,
                             double acceleration_sigma_m_s2) {
  P_ = (F * P_ * F.transpose()).eval();

  const double q_speed = square(acceleration_sigma_m_s2);
  const Eigen::Vector2d with_speed = 0.5 * q_speed * dt_s * dt_s * t;
  P_.topLeftCorner<2, 2>() += q_speed * dt_s * dt_s * dt_s / 3.0 * t * t.transpose();
  P_.block<2, 1>(kX, kSpeed) += with_speed;
  P_.block<1, 2>(kSpeed, kX) += with_speed.transpose();
  P_(kSpeed, kSpeed) += q_speed * dt_s;

  // A state that fades gets the noise that keeps its deviation.
  const auto keep = [&](int i, double sigma) { P_(i, i) += square(sigma) * (1.0 - square(F(i, i))); };
  keep(kSlip, slip_sigma_m_s(state_(kSpeed)));
  keep(kTurn, kTurnSigma_rad_s);
  keep(kBackBias, kBackBiasSigma_rad);
  keep(kClothBias, kClothBiasSigma_rad);
  keep(kCloth, 1.0);
  P_(kPsi, kPsi) += kTurnDensity * dt_s * dt_s * dt_s / 3.0;
  P_(kPsi, kTurn) += 0.5 * kTurnDensity * dt_s * dt_s;
  P_(kTurn, kPsi) = P_(kPsi, kTurn);

  const double kept = std::exp(-2.0 * dt_s / kGaitMemory_s);
  const double excited = square(gait(state_(kSpeed))) * (1.0 - kept);
  P_.diagonal().segment<2>(kSwing).array() += square(kSwingSigma_rad) * excited;
  P_.diagonal().segment<2>(kSway).array() += square(kSwaySigma_m) * excited;
}

TravelFilter::Innovation TravelFilter::innovation(const BackMeasurement& back) const {
  const double back_yaw_rad = state_(kPsi) + state_(kSwing) + state_(kBackBias);
  Innovation difference;
  difference.head<2>() = back.position_m - state_.head<2>() + kBackBehindAxis_m * unit(back_yaw_rad) -
                         state_(kSway) * left_of(unit(state_(kPsi)));
  difference(2) =
      wrap_angle_rad(back.yaw_rad - back_yaw_rad - state_(kClothBias) - back.yaw_sigma_rad * state_(kCloth));
  return difference;
}

/// Jacobian of what a frame measures: x, y, yaw.
TravelFilter::Observation TravelFilter::observation(const BackMeasurement& back) const {
  const Eigen::Vector2d t = unit(state_(kPsi));
  const Eigen::Vector2d turned =
      -kBackBehindAxis_m * left_of(unit(state_(kPsi) + state_(kSwing) + state_(kBackBias)));
  Observation H = Observation::Zero();
  H.topLeftCorner<2, 2>().setIdentity();
  H.block<2, 1>(0, kPsi) = turned - state_(kSway) * t;
  H.block<2, 1>(0, kSwing) = turned;
  H.block<2, 1>(0, kBackBias) = turned;
  H.block<2, 1>(0, kSway) = left_of(t);
  H(2, kPsi) = H(2, kSwing) = H(2, kBackBias) = H(2, kClothBias) = 1.0;
  H(2, kCloth) = back.yaw_sigma_rad;
  return H;
}

void TravelFilter::correct(const BackMeasurement& back) {
  const Innovation difference = innovation(back);
  const Observation H = observation(back);
  const Eigen::Matrix<double, kStates, 3> PHt = P_ * H.transpose();
  Eigen::Matrix3d S = H * PHt;
  S.topLeftCorner<2, 2>() += back.R_position;
  S(2, 2) += square(kYawNoise_rad);
  S(2, 2) = std::max(S(2, 2), square(difference(2) / kFarOff));
  const Eigen::Matrix<double, kStates, 3> W = PHt * S.inverse();
  state_ += W * difference;
  P_ = (P_ - W * S * W.transpose()).eval();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  limit_bias();
}

/// The most probable state with a bias within the limit (D. Simon, "Optimal State Estimation", 2006, section
/// 7.5: projection by P). Continuous in the state.
void TravelFilter::limit_bias() {
  const double bias_rad = state_(kBackBias) + state_(kClothBias);
  const double excess_rad = bias_rad - std::clamp(bias_rad, -kBiasLimit_rad, kBiasLimit_rad);
  const State with_bias = P_.col(kBackBias) + P_.col(kClothBias);
  state_ -= excess_rad / (with_bias(kBackBias) + with_bias(kClothBias)) * with_bias;
}

DirectionEstimate TravelFilter::travel(double ahead_s) const {
  const double turn_s = turning_s(ahead_s);
  const double variance = P_(kPsi, kPsi) + 2.0 * turn_s * P_(kPsi, kTurn) +
                          square(turn_s) * P_(kTurn, kTurn) +
                          kTurnDensity * ahead_s * ahead_s * ahead_s / 3.0;
  return {state_(kPsi) + turn_s * state_(kTurn), std::sqrt(variance)};
}

TravelFilter::Walk TravelFilter::walk() const {
  // The larger eigenvalue of the position's covariance.
  const double mean = 0.5 * (P_(kX, kX) + P_(kY, kY));
  const double variance = mean + std::hypot(0.5 * (P_(kX, kX) - P_(kY, kY)), P_(kX, kY));
  return {state_.head<2>(),
          std::sqrt(variance),
          state_(kSpeed),
          std::sqrt(P_(kSpeed, kSpeed)),
          state_(kSlip),
          state_(kTurn),
          std::sqrt(P_(kTurn, kTurn))};
}

DirectionEstimate TravelFilter::stride() const {
  return {state_(kMean3), std::sqrt(P_(kMean3, kMean3))};
}

}  // namespace heel
