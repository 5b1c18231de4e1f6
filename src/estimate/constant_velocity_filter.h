// A Kalman filter of N coordinates whose velocity changes by white acceleration noise.
// State s = (p, v); F = [I dt·I; 0 I]; Y. Bar-Shalom, X. Li, T. Kirubarajan, "Estimation with Applications to
// Tracking and Navigation", 2001, section 6.2.2 (continuous white noise acceleration) and 5.2.3 (the filter).
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace heel {

template <int N>
class ConstantVelocityFilter {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  /// Starts at a measured position, with velocity zero ± velocity_sigma.
  void start(const Vector& position, const Matrix& R, double velocity_sigma) {
    state_.setZero();
    state_.template head<N>() = position;
    P_.setZero();
    P_.template topLeftCorner<N, N>() = R;
    P_.template bottomRightCorner<N, N>() = velocity_sigma * velocity_sigma * Matrix::Identity();
  }

  /// `acceleration_sigma`: standard deviation of the velocity's change in one second.
  void predict(double dt_s, double acceleration_sigma) {
    State2 F = State2::Identity();
    F.template topRightCorner<N, N>() = dt_s * Matrix::Identity();
    const double q = acceleration_sigma * acceleration_sigma;
    State2 Q;
    Q << dt_s * dt_s * dt_s / 3.0 * Matrix::Identity(), dt_s * dt_s / 2.0 * Matrix::Identity(),
        dt_s * dt_s / 2.0 * Matrix::Identity(), dt_s * Matrix::Identity();
    state_ = F * state_;
    P_ = (F * P_ * F.transpose() + q * Q).eval();  // Eq. (5.2.3-5)
  }

  /// Squared Mahalanobis distance of an innovation (measured − predicted; the caller wraps angles).
  double distance_squared(const Vector& innovation, const Matrix& R) const {
    return innovation.dot(innovation_covariance(R).inverse() * innovation);
  }

  void correct(const Vector& innovation, const Matrix& R) {
    const Eigen::Matrix<double, 2 * N, N> W =
        P_.template leftCols<N>() * innovation_covariance(R).inverse();  // Eq. (5.2.3-11)
    state_ += W * innovation;
    P_ = (P_ - W * innovation_covariance(R) * W.transpose()).eval();  // Eq. (5.2.3-15)
    P_ = (0.5 * (P_ + P_.transpose())).eval();
  }

  Vector position() const { return state_.template head<N>(); }
  Vector velocity() const { return state_.template tail<N>(); }
  Matrix position_covariance() const { return P_.template topLeftCorner<N, N>(); }

 private:
  using State = Eigen::Matrix<double, 2 * N, 1>;
  using State2 = Eigen::Matrix<double, 2 * N, 2 * N>;

  Matrix innovation_covariance(const Matrix& R) const { return P_.template topLeftCorner<N, N>() + R; }

  State state_ = State::Zero();
  State2 P_ = State2::Identity();
};

}  // namespace heel
