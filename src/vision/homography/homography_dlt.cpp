// Normalised direct linear transformation (Hartley & Zisserman, 2nd ed., Algorithm 4.2).
// Convention: x_cur ~ H_cur_from_ref x_ref. Allocates nothing.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "heel/homography.h"

namespace heel {
namespace {

// Of singular values, relative to the largest. Well spread points give 1e-2 after normalisation; at 1e-6 the
// solution depends on a millionth of a pixel.
constexpr double kRelativeTolerance = 1e-6;

using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

/// The similarity x' = scale (x − centre) that brings points to zero mean and mean distance √2.
struct Normalisation {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double scale = 0.0;

  Eigen::Vector2d apply(const Eigen::Vector2d& point) const { return scale * (point - centre); }
  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d T;
    T << scale, 0.0, -scale * centre.x(), 0.0, scale, -scale * centre.y(), 0.0, 0.0, 1.0;
    return T;
  }
  Eigen::Matrix3d inverse_matrix() const {
    Eigen::Matrix3d T;
    T << 1.0 / scale, 0.0, centre.x(), 0.0, 1.0 / scale, centre.y(), 0.0, 0.0, 1.0;
    return T;
  }
};

Normalisation normalise(std::span<const PointPair> pairs, Eigen::Vector2d PointPair::*point) {
  Normalisation normalisation;
  for (const PointPair& pair : pairs) normalisation.centre += pair.*point;
  normalisation.centre /= static_cast<double>(pairs.size());
  double distance = 0.0;
  for (const PointPair& pair : pairs) distance += (pair.*point - normalisation.centre).norm();
  distance /= static_cast<double>(pairs.size());
  normalisation.scale =
      std::sqrt(2.0) / distance;  // not finite if all points coincide; checked by the caller
  return normalisation;
}

/// AᵀA of the 2n × 9 design matrix, Eq. (4.3): rows (0, −xᵀ, y' xᵀ) and (xᵀ, 0, −x' xᵀ) with x = (x, y, 1).
/// Its nine 3 × 3 blocks are sums of x xᵀ weighted by 1, −x', −y' and x'² + y'².
Matrix9d normal_matrix(std::span<const PointPair> pairs, const Normalisation& ref, const Normalisation& cur) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero(), sum_x = sum, sum_y = sum, sum_r2 = sum;
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d x = ref.apply(pair.ref_px).homogeneous();
    const Eigen::Vector2d target = cur.apply(pair.cur_px);
    const Eigen::Matrix3d outer = x * x.transpose();
    sum += outer;
    sum_x += target.x() * outer;
    sum_y += target.y() * outer;
    sum_r2 += target.squaredNorm() * outer;
  }
  Matrix9d N = Matrix9d::Zero();
  N.block<3, 3>(0, 0) = sum;
  N.block<3, 3>(3, 3) = sum;
  N.block<3, 3>(6, 6) = sum_r2;
  N.block<3, 3>(0, 6) = N.block<3, 3>(6, 0) = -sum_x;
  N.block<3, 3>(3, 6) = N.block<3, 3>(6, 3) = -sum_y;
  return N;
}

}  // namespace

HomographyStatus homography_dlt(std::span<const PointPair> pairs, Eigen::Matrix3d& H_cur_from_ref) {
  if (pairs.size() < 4) return HomographyStatus::TooFewPairs;
  const Normalisation ref = normalise(pairs, &PointPair::ref_px);
  const Normalisation cur = normalise(pairs, &PointPair::cur_px);
  if (!std::isfinite(ref.scale) || !std::isfinite(cur.scale)) return HomographyStatus::Degenerate;

  // The squared singular values of the design matrix, ascending. If the second is near zero, more than one
  // homography fits (three of four points are collinear, or all points lie on one line).
  const Eigen::SelfAdjointEigenSolver<Matrix9d> solver(normal_matrix(pairs, ref, cur));
  const Vector9d& squared = solver.eigenvalues();
  const double tolerance2 = kRelativeTolerance * kRelativeTolerance;
  if (!(squared(1) > tolerance2 * squared(8))) return HomographyStatus::Degenerate;

  const Vector9d h = solver.eigenvectors().col(0);
  Eigen::Matrix3d H;
  H << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), h(8);
  // A singular solution maps the plane to a line (the points are collinear in one view only).
  const Eigen::Vector3d singular = Eigen::JacobiSVD<Eigen::Matrix3d>(H).singularValues();
  if (!(singular(2) > kRelativeTolerance * singular(0))) return HomographyStatus::Degenerate;

  H = cur.inverse_matrix() * H * ref.matrix();
  // H(2,2) = 0 if the reference origin maps to infinity; then H is scaled to norm 1.
  const double corner = H(2, 2);
  H /= std::abs(corner) > 1e-12 * H.norm() ? corner : H.norm();
  if (!H.allFinite()) return HomographyStatus::Degenerate;
  H_cur_from_ref = H;
  return HomographyStatus::Ok;
}

}  // namespace heel
