#include "vision/pose/surface_pose_solver.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "vision/optimisation/projection.h"

namespace heel {
namespace {

constexpr double kSettled = 1e-4;  // rad and t/d

// Shares of BackSurface::shape_sigma, 4 mm by default: how far cloth lies from where it hung when it was
// taught. Measured on cloth simulated by others: from patch to patch 3 mm; along the cloth 3 mm, of which the
// keystone and the stretch (at the region's corner and lower edge) are estimated with the pose. Larger
// shares explain a turn as a change of the cloth; smaller shares explain a change of the cloth as a turn.
constexpr double kPatchShare = 0.75, kTangentialShare = 0.75, kKeystoneShare = 0.75, kStretchShare = 0.2;
constexpr double kMinSigma = 1e-6;  // in units of d; keeps precisions finite

// A plane is taken for a board, which neither hangs nor stretches.
double keystone_sigma(const BackSurface& surface) {
  return std::max(kMinSigma, surface.flat() ? 0.0 : kKeystoneShare * surface.shape_sigma);
}
double stretch_sigma(const BackSurface& surface) {
  return std::max(kMinSigma, surface.flat() ? 0.0 : kStretchShare * surface.shape_sigma);
}

double precision_of(double sigma) {
  return 1.0 / (sigma * sigma);
}

FrontalMotion turned_and_moved(const FrontalMotion& motion, const Eigen::Vector3d& omega,
                               const Eigen::Vector3d& delta_t) {
  FrontalMotion moved = motion;
  const double angle = omega.norm();
  if (angle > 0.0)
    moved.R_cur_from_ref = Eigen::AngleAxisd(angle, omega / angle).toRotationMatrix() * motion.R_cur_from_ref;
  moved.t_over_d = motion.t_over_d + delta_t;
  return moved;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return cross;
}

}  // namespace

SurfacePoseSolver::SurfacePoseSolver(const Eigen::Matrix3d& K_cur, std::size_t max_observations)
    : K_cur_(K_cur), max_observations_(max_observations) {
  linearised_.reserve(max_observations);
}

void SurfacePoseSolver::linearise(const BackSurface& surface,
                                  std::span<const SurfaceObservation> observations,
                                  const FrontalMotion& motion) {
  linearised_.resize(observations.size());
  const Eigen::Matrix3d& R = motion.R_cur_from_ref;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const SurfaceObservation& observation = observations[i];
    LinearisedObservation& l = linearised_[i];
    l.ray = observation.ray;
    const double v = surface.v(observation.ray), uv = surface.u(observation.ray) * v;
    Eigen::Vector3d point_ref = surface.point(observation.ray);
    point_ref.y() += uv * keystone_ + v * stretch_;
    const Eigen::Vector3d rotated = R * point_ref;
    const Eigen::Vector3d pixel = K_cur_ * (rotated + motion.t_over_d);
    const Matrix23d by_cur = projection_jacobian(pixel) * K_cur_;
    l.residual_px = observation.cur_px - pixel.hnormalized();
    l.by_point = by_cur * R;
    l.J.leftCols<3>() = -by_cur * cross_matrix(rotated);  // a rotation ω moves the point by ω × r
    l.J.middleCols<3>(3) = by_cur;
    l.J.col(6) = uv * l.by_point.col(1);
    l.J.col(7) = v * l.by_point.col(1);
    const double cloth_px = kPatchShare * surface.shape_sigma * K_cur_(0, 0) / pixel.z();
    l.information = (observation.covariance + cloth_px * cloth_px * Eigen::Matrix2d::Identity()).inverse();
    l.squared = l.residual_px.dot(l.information * l.residual_px);
    const double w = 1.0 / (1.0 + l.squared / kMaxCost);
    l.weight = w * w;
  }
}

SurfacePoseSolver::Matrix8d SurfacePoseSolver::nuisance_precision() const {
  Matrix8d precision = Matrix8d::Zero();
  precision(6, 6) = precision_of(keystone_sigma(surface_));
  precision(7, 7) = precision_of(stretch_sigma(surface_));
  return precision;
}

double SurfacePoseSolver::cost(std::size_t observation) const {
  const double squared = linearised_[observation].squared;
  return squared / (1.0 + squared / kMaxCost);
}

/// The first step is not robust: the start may be off by more than the robust cost reaches.
FrontalMotion SurfacePoseSolver::solve(const BackSurface& surface,
                                       std::span<const SurfaceObservation> observations,
                                       const FrontalMotion& start, int max_steps,
                                       const std::optional<MotionPrior>& prior) {
  surface_ = surface;
  keystone_ = stretch_ = 0.0;
  observations = observations.first(std::min(observations.size(), max_observations_));
  Matrix8d prior_precision = nuisance_precision();
  if (prior) {
    prior_precision.diagonal().head<3>() = prior->turn_rad.unaryExpr(&precision_of);
    prior_precision.diagonal().segment<3>(3) = prior->t_over_d.unaryExpr(&precision_of);
  }

  FrontalMotion motion = start;
  Vector8d from_start = Vector8d::Zero();
  for (int step = 0; step < max_steps; ++step) {
    linearise(surface, observations, motion);
    Matrix8d N = prior_precision;
    Vector8d gradient = -prior_precision * from_start;
    for (const LinearisedObservation& l : linearised_) {
      const Eigen::Matrix<double, kUnknowns, 2> weighted =
          (step == 0 ? 1.0 : l.weight) * l.J.transpose() * l.information;
      N.noalias() += weighted * l.J;
      gradient.noalias() += weighted * l.residual_px;
    }
    const Vector8d increment = N.ldlt().solve(gradient);
    motion = turned_and_moved(motion, increment.head<3>(), increment.segment<3>(3));
    from_start += increment;
    keystone_ = from_start(6);
    stretch_ = from_start(7);
    if (step > 1 && increment.head<6>().norm() < kSettled) break;
  }
  motion.R_cur_from_ref = Eigen::Quaterniond(motion.R_cur_from_ref).normalized().toRotationMatrix();
  linearise(surface, observations, motion);
  return motion;
}

/// The noise gives N⁻¹. A departure a, N(0, 1), moves the minimum by N⁻¹ Σ w Jᵀ W (∂ px / ∂a): it adds the
/// square of that. Six departures lie along the cloth, five along the normal: cloth hangs otherwise than when
/// it was taught. Four lie along the reference ray: the body's shape is not the average one, then and now.
Matrix6d SurfacePoseSolver::covariance() const {
  constexpr int kModes = 15;
  const double tangential = kTangentialShare * surface_.shape_sigma, normal = surface_.shape_sigma;
  const double body = surface_.bend_sigma * surface_.half_size.x() * surface_.half_size.x();
  Matrix8d N = nuisance_precision();
  Eigen::Matrix<double, kUnknowns, kModes> moved = Eigen::Matrix<double, kUnknowns, kModes>::Zero();
  for (const LinearisedObservation& l : linearised_) {
    const Eigen::Matrix<double, kUnknowns, 2> weighted = l.weight * l.J.transpose() * l.information;
    N.noalias() += weighted * l.J;
    const double u = surface_.u(l.ray), v = surface_.v(l.ray);
    const double uu = u * u - 1.0 / 3.0, vv = v * v - 1.0 / 3.0, uv = u * v, uuu = u * u * u - 0.6 * u;
    const Eigen::Vector2d along_x = tangential * l.by_point.col(0), along_y = tangential * l.by_point.col(1);
    const Eigen::Vector2d along_normal = normal * l.by_point.col(2), along_ray = body * l.by_point * l.ray;
    Eigen::Matrix<double, 2, kModes> by_mode;
    by_mode << 0.5 * u * along_x, uu * along_x, uv * along_x, vv * along_x, uu * along_y, vv * along_y,  //
        u * along_normal, v * along_normal, uu * along_normal, uv * along_normal, vv * along_normal,     //
        u * along_ray, uu * along_ray, uv * along_ray, uuu * along_ray;
    moved.noalias() += weighted * by_mode;
  }
  const Matrix8d of_noise = N.ldlt().solve(Matrix8d::Identity());
  const Eigen::Matrix<double, kUnknowns, kModes> by_departures = of_noise * moved;
  const Matrix8d covariance = of_noise + by_departures * by_departures.transpose();
  return covariance.topLeftCorner<6, 6>();
}

}  // namespace heel
