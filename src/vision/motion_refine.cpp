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
constexpr double kBehindCost = 1e12;  // px², of a point that would lie behind the camera

struct Pose {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
};

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return S;
}

/// Inverse covariance of a forward residual, noise 1 px in both images: (I + D Dᵀ)⁻¹, D = d cur / d ref.
Eigen::Matrix2d whitening(const Eigen::Matrix3d& H, const Eigen::Vector2d& ref_px) {
  const Eigen::Matrix2d D = projection_jacobian(H * ref_px.homogeneous()) * H.leftCols<2>();
  return (Eigen::Matrix2d::Identity() + D * D.transpose()).inverse();
}

/// Evaluates the problem's cost, and on request its Gauss–Newton equations.
double evaluate(const FrontalProblem& problem, const Pose& pose, GaussNewtonEquations<6>* equations) {
  const Eigen::Matrix3d K_ref_inverse = problem.K_ref.inverse();
  double cost = 0.0;
  for (const PointPair& pair : problem.pairs) {
    const Eigen::Vector3d rotated = pose.R * (K_ref_inverse * pair.ref_px.homogeneous());
    const Eigen::Vector3d X_cur = rotated + pose.t;
    if (X_cur.z() <= 0.0) {
      cost += kBehindCost;
      continue;
    }
    const Eigen::Vector3d pixel = problem.K_cur * X_cur;
    const Eigen::Vector2d residual = pixel.hnormalized() - pair.cur_px;
    const Eigen::Matrix2d W = whitening(problem.H_cur_from_ref, pair.ref_px);
    cost += residual.dot(W * residual);
    if (equations == nullptr) continue;
    const Matrix23d by_point = projection_jacobian(pixel) * problem.K_cur;
    Matrix26d J;
    J << by_point * -skew(rotated), by_point;
    equations->N += J.transpose() * W * J;
    equations->gradient += J.transpose() * (W * residual);
  }
  return cost;
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
  const FrontalProblem& problem;

  double cost(const Pose& pose) const { return evaluate(problem, pose, nullptr); }
  GaussNewtonEquations<6> equations(const Pose& pose) const {
    GaussNewtonEquations<6> equations;
    evaluate(problem, pose, &equations);
    return equations;
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

FrontalMotion refine_frontal_motion(const FrontalProblem& problem, const PlaneMotion& start) {
  const PoseDescent descent{problem};
  Pose pose{start.R_cur_from_ref, start.t_over_d};
  const double cost = levenberg_marquardt(descent, kMotionDescent, pose);

  FrontalMotion motion;
  motion.R_cur_from_ref = Eigen::Quaterniond(pose.R).normalized().toRotationMatrix();
  motion.t_over_d = pose.t;
  motion.cost_px2 = cost;
  const double variance = cost / std::max(1.0, 2.0 * static_cast<double>(problem.pairs.size()) - 6.0);
  motion.noise_px = std::sqrt(variance);
  motion.covariance = variance * descent.equations(pose).N.inverse();
  return motion;
}

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

FrontalPose estimate_frontal_pose(const FrontalProblem& problem, const PlaneMotion& start) {
  FrontalMotion chosen = refine_frontal_motion(problem, start);
  FrontalMotion other = refine_frontal_motion(problem, mirrored_motion(problem, chosen));
  if (other.cost_px2 < chosen.cost_px2) std::swap(chosen, other);

  FrontalPose pose;
  pose.motion = chosen;
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
