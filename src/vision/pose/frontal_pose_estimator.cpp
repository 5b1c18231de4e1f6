#include "vision/pose/frontal_pose_estimator.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/optimisation/levenberg_marquardt.h"
#include "vision/optimisation/projection.h"
#include "vision/pose/alternative_hypotheses.h"

namespace heel {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr int kStepsToMinimum = 30;
constexpr double kMinVariance_px2 = 1e-4;  // no feature is placed more precisely than 0.01 px
constexpr double kSameMinimum = 1e-3;      // √2 times the angle between two rotations
constexpr double kPriorTOverD = 10.0;      // standard deviation of t/d without any pair
constexpr double kBehindCost_px2 = 1e12;   // of a point behind the camera

struct Pose {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
};

using WhitenedPair = FrontalPoseEstimator::WhitenedPair;

/// L⁻¹ with S = L Lᵀ, where S = I + D Dᵀ is the covariance of a forward residual r if the noise is 1 px in
/// both images, and D = d cur / d ref. L⁻¹ r has covariance I.
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

/// The cost of the pose as a problem for levenberg_marquardt.
struct PoseDescent {
  std::span<const WhitenedPair> pairs;
  FrontalPoseEstimator::Linearised& linearised;

  /// Fills `linearised` and returns the cost. A point behind the camera has zero residual and derivative.
  double linearise(const Pose& pose) const {
    double cost = 0.0;
    Eigen::Index row = 0;
    for (const WhitenedPair& pair : pairs) {
      const Eigen::Vector3d r = pose.R * pair.point_ref;
      const Eigen::Vector3d point = r + pose.t;
      Eigen::Vector2d residual = Eigen::Vector2d::Zero(), by_x = residual, by_y = residual, by_z = residual;
      if (point.z() > 0.0) {
        const double inverse_z = 1.0 / point.z();
        const Eigen::Vector2d direction = inverse_z * point.head<2>();
        residual = pair.whitening * (direction - pair.direction);
        by_x = inverse_z * pair.whitening.col(0);
        by_y = inverse_z * pair.whitening.col(1);
        by_z = -direction.x() * by_x - direction.y() * by_y;
        cost += residual.squaredNorm();
      } else {
        cost += kBehindCost_px2;
      }
      const auto set = [&](Eigen::Index column, const Eigen::Vector2d& by) {
        linearised.J.col(column).segment<2>(row) = by;
      };
      set(0, r.y() * by_z - r.z() * by_y);  // a rotation ω moves the point by ω × r
      set(1, r.z() * by_x - r.x() * by_z);
      set(2, r.x() * by_y - r.y() * by_x);
      set(3, by_x);
      set(4, by_y);
      set(5, by_z);
      linearised.residuals.segment<2>(row) = residual;
      row += 2;
    }
    return cost;
  }

  GaussNewtonEquations<6> equations(const Pose& pose) const {
    GaussNewtonEquations<6> equations;
    equations.cost = linearise(pose);
    const auto J = linearised.J.topRows(rows());
    equations.N = normal_matrix();
    for (int i = 0; i < 6; ++i) equations.gradient(i) = J.col(i).dot(linearised.residuals.head(rows()));
    return equations;
  }

  /// Jᵀ J at the linearised pose.
  Matrix6d normal_matrix() const {
    const auto J = linearised.J.topRows(rows());
    Matrix6d N;
    for (int i = 0; i < 6; ++i)
      for (int k = i; k < 6; ++k) N(i, k) = N(k, i) = J.col(i).dot(J.col(k));
    return N;
  }

  Eigen::Index rows() const { return 2 * static_cast<Eigen::Index>(pairs.size()); }

  /// The noise gives N'⁻¹ with N' = N / σ² + P, where P is the prior's precision. A departure a of the
  /// surface moves the minimum by −N'⁻¹ Σ Jᵀ (∂r/∂a) / σ²; each departure is N(0, 1) and adds the square of
  /// that.
  Matrix6d covariance(const Pose& pose, double variance_px2) const {
    linearise(pose);
    const Eigen::Vector3d normal = pose.R.col(2);
    Matrix6d sum_by_departure = Matrix6d::Zero();
    Eigen::Index row = 0;
    for (const WhitenedPair& pair : pairs) {
      const Eigen::Vector3d ray = pose.R * (pair.point_ref / pair.point_ref.z());
      for (int axis = 0; axis < 2; ++axis, ++row) {
        const auto J = linearised.J.row(row);
        Vector6d by_departure_px;
        by_departure_px << J.tail<3>().dot(normal) * pair.departures,
            J.tail<3>().dot(ray) * pair.departure_of_bend;
        sum_by_departure += J.transpose() * by_departure_px.transpose();
      }
    }
    Matrix6d precision = normal_matrix() / variance_px2;
    precision.diagonal().head<3>().array() += 1.0 / (M_PI * M_PI);
    precision.diagonal().tail<3>().array() += 1.0 / (kPriorTOverD * kPriorTOverD);
    const Matrix6d of_noise = precision.ldlt().solve(Matrix6d::Identity());
    const Matrix6d moved = of_noise * sum_by_departure / variance_px2;
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

Eigen::Matrix3d half_turn_about(const Eigen::Vector3d& axis) {
  return 2.0 * axis * axis.transpose() - Eigen::Matrix3d::Identity();
}

}  // namespace

PlaneMotion mirrored_motion(const FrontalProblem& problem, const FrontalMotion& motion) {
  const Eigen::Vector3d centre_ref = problem.K_ref.inverse() * problem.centre_ref_px.homogeneous();
  const Eigen::Vector3d centre_cur = motion.R_cur_from_ref * centre_ref + motion.t_over_d;
  const Eigen::Vector3d sight = centre_cur.normalized();
  const Eigen::Vector3d normal_cur = motion.R_cur_from_ref.col(2);
  // A half turn about the normal followed by a half turn about the line of sight is a rotation by twice the
  // angle between the two.
  PlaneMotion other;
  other.R_cur_from_ref = half_turn_about(sight) * half_turn_about(normal_cur) * motion.R_cur_from_ref;
  other.t_over_d = centre_cur - other.R_cur_from_ref * centre_ref;
  return other;
}

double yaw_sigma_rad(const Eigen::Matrix3d& R_cur_from_ref, const Matrix6d& covariance) {
  const Eigen::Vector3d gradient = yaw_gradient(R_cur_from_ref);
  return std::sqrt(gradient.dot(covariance.topLeftCorner<3, 3>() * gradient));
}

FrontalPoseEstimator::FrontalPoseEstimator(std::size_t max_pairs) : capacity_(max_pairs) {
  pairs_.reserve(capacity_);
  linearised_.J.resize(2 * static_cast<Eigen::Index>(capacity_), 6);
  linearised_.residuals.resize(2 * static_cast<Eigen::Index>(capacity_));
}

std::span<const FrontalPoseEstimator::WhitenedPair> FrontalPoseEstimator::whiten(
    const FrontalProblem& problem) {
  const Eigen::Matrix3d K_ref_inverse = problem.K_ref.inverse(), K_cur_inverse = problem.K_cur.inverse();
  pairs_.clear();
  for (const PointPair& pair : problem.pairs.first(std::min(problem.pairs.size(), capacity_))) {
    const Eigen::Vector3d ray = K_ref_inverse * pair.ref_px.homogeneous();
    pairs_.push_back({problem.surface.point(ray), (K_cur_inverse * pair.cur_px.homogeneous()).head<2>(),
                      whitening(problem.H_cur_from_ref, pair.ref_px) * problem.K_cur.topLeftCorner<2, 2>(),
                      problem.surface.departures(ray), problem.surface.departure_of_bend(ray)});
  }
  return pairs_;
}

FrontalMotion FrontalPoseEstimator::refine(const FrontalProblem& problem, const PlaneMotion& start,
                                           int max_steps) {
  return descend(whiten(problem), start, max_steps);
}

FrontalMotion FrontalPoseEstimator::descend(std::span<const WhitenedPair> pairs, const PlaneMotion& start,
                                            int max_steps) {
  Pose pose{start.R_cur_from_ref, start.t_over_d};
  const double cost = levenberg_marquardt(
      PoseDescent{pairs, linearised_},
      DescentLimits{.max_steps = max_steps, .converged = 1e-5, .max_damping = 1e10}, pose);
  FrontalMotion motion;
  motion.R_cur_from_ref = Eigen::Quaterniond(pose.R).normalized().toRotationMatrix();
  motion.t_over_d = pose.t;
  motion.cost_px2 = cost;
  motion.noise_px = std::sqrt(cost / std::max(1.0, 2.0 * static_cast<double>(pairs.size()) - 6.0));
  return motion;
}

FrontalPose FrontalPoseEstimator::estimate(const FrontalProblem& problem, const PlaneMotion& start) {
  const std::span<const WhitenedPair> pairs = whiten(problem);
  FrontalMotion chosen = descend(pairs, start, kStepsToMinimum);
  FrontalMotion other = descend(pairs, mirrored_motion(problem, chosen), kStepsToMinimum);
  if (other.cost_px2 < chosen.cost_px2) std::swap(chosen, other);

  FrontalPose pose;
  pose.motion = chosen;
  pose.other = other;
  pose.covariance = PoseDescent{pairs, linearised_}.covariance(
      {chosen.R_cur_from_ref, chosen.t_over_d},
      std::max(chosen.noise_px * chosen.noise_px, kMinVariance_px2));
  pose.yaw_rad = yaw_of_rotation(chosen.R_cur_from_ref);
  // The odds of two hypotheses of equal prior are exp(−Δχ²/2).
  const double chi2_excess =
      (other.cost_px2 - chosen.cost_px2) / std::max(chosen.noise_px * chosen.noise_px, 1e-12);
  const bool same = (chosen.R_cur_from_ref - other.R_cur_from_ref).norm() < kSameMinimum;
  const AlternativeHypothesis mirrored{other, same ? 0.0 : std::exp(-0.5 * std::max(0.0, chi2_excess))};

  pose.yaw_sigma_rad = yaw_sigma_rad(chosen.R_cur_from_ref, pose.covariance);
  pose.t_over_d_sigma = pose.covariance.diagonal().tail<3>().cwiseSqrt();
  inflate_covariance({&mirrored, 1}, pose);
  return pose;
}

}  // namespace heel
