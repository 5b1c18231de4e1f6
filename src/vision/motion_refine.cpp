#include "motion_refine.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "levenberg_marquardt.h"
#include "projection.h"

namespace heel {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix26d = Eigen::Matrix<double, 2, 6>;

constexpr DescentLimits kMotionDescent{.max_steps = 30, .converged = 1e-8, .max_damping = 1e10};
constexpr double kLeastVariance = 1e-4;  // px²; no feature is placed better than to 0.01 px
constexpr double kFarthest = 10.0;       // d, before anything is seen
constexpr double kBehindCost = 1e12;     // px², of a point that would lie behind the camera

struct Pose {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
};

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return S;
}

using WhitenedPair = FrontalPoseEstimator::WhitenedPair;

/// Of a forward residual whose noise is 1 px in both images: its covariance is S = I + D Dᵀ, D = d cur / d
/// ref, and L⁻¹ r with S = L Lᵀ has covariance I.
Eigen::Matrix2d whitening(const Eigen::Matrix3d& H, const Eigen::Vector2d& ref_px) {
  const Eigen::Matrix2d D = projection_jacobian(H * ref_px.homogeneous()) * H.leftCols<2>();
  const Eigen::Matrix2d S = Eigen::Matrix2d::Identity() + D * D.transpose();
  const double l00 = std::sqrt(S(0, 0)), l10 = S(1, 0) / l00, l11 = std::sqrt(S(1, 1) - l10 * l10);
  Eigen::Matrix2d L_inverse;
  L_inverse << 1.0 / l00, 0.0, -l10 / (l00 * l11), 1.0 / l11;
  return L_inverse;
}

Pose turned_and_moved(const Pose& pose, const Vector6d& step) {
  const Eigen::Vector3d omega = step.head<3>();
  const double angle = omega.norm();
  const Eigen::Matrix3d turn =
      angle > 0.0 ? Eigen::AngleAxisd(angle, omega / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
  return {turn * pose.R, pose.t + step.tail<3>()};
}

/// The problem as the minimiser sees it.
struct PoseDescent {
  std::span<const WhitenedPair> pairs;
  const Eigen::Matrix3d& K_cur;

  double cost(const Pose& pose) const {
    const Eigen::Matrix3d KR = K_cur * pose.R;
    const Eigen::Vector3d Kt = K_cur * pose.t;
    double cost = 0.0;
    for (const WhitenedPair& pair : pairs) {
      const Eigen::Vector3d pixel = KR * pair.point_ref + Kt;  // its third component is the depth
      cost += pixel.z() > 0.0 ? (pair.whitening * (pixel.hnormalized() - pair.cur_px)).squaredNorm()
                              : kBehindCost;
    }
    return cost;
  }

  /// d whitened residual / d (ω, δt).
  Matrix26d jacobian(const WhitenedPair& pair, const Eigen::Vector3d& rotated,
                     const Eigen::Vector3d& pixel) const {
    const Matrix23d by_point = pair.whitening * projection_jacobian(pixel) * K_cur;
    Matrix26d J;
    J << by_point * -skew(rotated), by_point;
    return J;
  }

  GaussNewtonEquations<6> equations(const Pose& pose) const {
    GaussNewtonEquations<6> equations;
    for (const WhitenedPair& pair : pairs) {
      const Eigen::Vector3d rotated = pose.R * pair.point_ref;
      const Eigen::Vector3d pixel = K_cur * (rotated + pose.t);
      if (pixel.z() <= 0.0) continue;
      const Eigen::Vector2d residual = pair.whitening * (pixel.hnormalized() - pair.cur_px);
      const Matrix26d J = jacobian(pair, rotated, pixel);
      equations.N.noalias() += J.transpose() * J;
      equations.gradient.noalias() += J.transpose() * residual;
    }
    return equations;
  }

  /// With N' = N / σ² + P, P the little that is known beforehand, the noise gives N'⁻¹. A departure of the
  /// surface moves the minimum by −N'⁻¹ Σ Jᵀ (∂r/∂a) / σ²: the departures, known by their deviation only, add
  /// the squares of that.
  Matrix6d covariance(const Pose& pose, double variance_px2) const {
    Matrix6d N = Matrix6d::Zero();
    Eigen::Matrix<double, 6, 5> by_shape = Eigen::Matrix<double, 6, 5>::Zero();
    for (const WhitenedPair& pair : pairs) {
      const Eigen::Vector3d rotated = pose.R * pair.point_ref;
      const Eigen::Vector3d pixel = K_cur * (rotated + pose.t);
      if (pixel.z() <= 0.0) continue;
      const Matrix26d J = jacobian(pair, rotated, pixel);
      const Eigen::Vector2d by_depth = J.rightCols<3>() * (rotated / pair.point_ref.z());
      N.noalias() += J.transpose() * J;
      by_shape.noalias() += J.transpose() * by_depth * pair.departures.transpose();
    }
    Matrix6d precision = N / variance_px2;
    precision.diagonal().head<3>().array() += 1.0 / (M_PI * M_PI);
    precision.diagonal().tail<3>().array() += 1.0 / (kFarthest * kFarthest);
    const Matrix6d of_noise = precision.inverse();
    const Eigen::Matrix<double, 6, 5> moved = of_noise * by_shape / variance_px2;
    return of_noise + moved * moved.transpose();
  }

  Pose stepped(const Pose& pose, const Vector6d& step) const { return turned_and_moved(pose, step); }
};

/// d yaw / d ω for R = exp(ω) R̂: yaw = atan2(c_x, c_z) with c = R (0,0,1), dc = ω × c.
Eigen::Vector3d yaw_gradient(const Eigen::Matrix3d& R) {
  const Eigen::Vector3d c = R.col(2);
  const double horizontal2 = std::max(c.x() * c.x() + c.z() * c.z(), 1e-12);
  const Eigen::Vector3d dx(0.0, c.z(), -c.y()), dz(c.y(), -c.x(), 0.0);
  return (c.z() * dx - c.x() * dz) / horizontal2;
}

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * M_PI);
}

}  // namespace

PlaneMotion mirrored_motion(const FrontalProblem& problem, const FrontalMotion& motion) {
  const Eigen::Vector3d centre_ref = problem.K_ref.inverse() * problem.centre_ref_px.homogeneous();
  const Eigen::Vector3d centre_cur = motion.R_cur_from_ref * centre_ref + motion.t_over_d;
  const Eigen::Vector3d sight = centre_cur.normalized();
  const Eigen::Vector3d normal_cur = motion.R_cur_from_ref.col(2);
  const Eigen::Vector3d mirrored = 2.0 * sight.dot(normal_cur) * sight - normal_cur;
  PlaneMotion other;
  other.R_cur_from_ref =
      Eigen::Quaterniond::FromTwoVectors(normal_cur, mirrored).toRotationMatrix() * motion.R_cur_from_ref;
  other.t_over_d = centre_cur - other.R_cur_from_ref * centre_ref;
  return other;
}

FrontalPoseEstimator::FrontalPoseEstimator(std::size_t max_pairs) : capacity_(max_pairs) {
  pairs_.reserve(capacity_);
}

void FrontalPoseEstimator::load(const FrontalProblem& problem) {
  const Eigen::Matrix3d K_ref_inverse = problem.K_ref.inverse();
  pairs_.clear();
  for (const PointPair& pair : problem.pairs.first(std::min(problem.pairs.size(), capacity_))) {
    const Eigen::Vector3d ray = K_ref_inverse * pair.ref_px.homogeneous();
    pairs_.push_back({problem.surface.point(ray), pair.cur_px, whitening(problem.H_cur_from_ref, pair.ref_px),
                      problem.surface.departures(ray)});
  }
}

FrontalMotion FrontalPoseEstimator::refine(const FrontalProblem& problem, const PlaneMotion& start) {
  load(problem);
  return descend(problem.K_cur, start);
}

FrontalMotion FrontalPoseEstimator::descend(const Eigen::Matrix3d& K_cur, const PlaneMotion& start) const {
  const PoseDescent descent{pairs_, K_cur};
  Pose pose{start.R_cur_from_ref, start.t_over_d};
  const double cost = levenberg_marquardt(descent, kMotionDescent, pose);

  FrontalMotion motion;
  motion.R_cur_from_ref = Eigen::Quaterniond(pose.R).normalized().toRotationMatrix();
  motion.t_over_d = pose.t;
  motion.cost_px2 = cost;
  const double variance = cost / std::max(1.0, 2.0 * static_cast<double>(pairs_.size()) - 6.0);
  motion.noise_px = std::sqrt(variance);
  motion.covariance = descent.covariance(pose, std::max(variance, kLeastVariance));
  return motion;
}

FrontalPose FrontalPoseEstimator::estimate(const FrontalProblem& problem, const PlaneMotion& start) {
  load(problem);
  FrontalMotion chosen = descend(problem.K_cur, start);
  FrontalMotion other = descend(problem.K_cur, mirrored_motion(problem, chosen));
  if (other.cost_px2 < chosen.cost_px2) std::swap(chosen, other);

  FrontalPose pose;
  pose.motion = chosen;
  pose.other = other;
  pose.yaw_rad = yaw_of_rotation(chosen.R_cur_from_ref);
  // Two hypotheses of equal prior: their odds are exp(−Δχ²/2).
  const double chi2_excess =
      (other.cost_px2 - chosen.cost_px2) / std::max(chosen.noise_px * chosen.noise_px, 1e-12);
  const double odds = std::exp(-0.5 * std::max(0.0, chi2_excess));
  pose.ambiguity = odds / (1.0 + odds);

  const Eigen::Vector3d gradient = yaw_gradient(chosen.R_cur_from_ref);
  const double apart_rad = wrapped(yaw_of_rotation(other.R_cur_from_ref) - pose.yaw_rad);
  pose.yaw_sigma_rad = std::sqrt(gradient.dot(chosen.covariance.topLeftCorner<3, 3>() * gradient) +
                                 pose.ambiguity * apart_rad * apart_rad);
  for (int i = 0; i < 3; ++i) {
    const double apart = other.t_over_d(i) - chosen.t_over_d(i);
    pose.t_over_d_sigma(i) = std::sqrt(chosen.covariance(3 + i, 3 + i) + pose.ambiguity * apart * apart);
  }
  return pose;
}

}  // namespace heel
