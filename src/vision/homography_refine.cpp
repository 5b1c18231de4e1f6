#include "homography_refine.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "levenberg_marquardt.h"
#include "projection.h"

namespace heel {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Vector8d = Eigen::Matrix<double, 8, 1>;

// Converged: far below what noise moves the cost by.
constexpr DescentLimits kHomographyDescent{.max_steps = 20, .converged = 1e-5, .max_damping = 1e8};

// A residual's derivative by the row-major entries of a 3 × 3 matrix Q, where it depends on Q through Q p
// only, is M ⊗ pᵀ with M (2 × 3). Its normal matrix Mᵀ W M ⊗ p pᵀ is a product of two symmetric 3 × 3
// matrices: 36 different numbers instead of 81, which is what is summed.
class NormalEquations {
 public:
  void add_gradient(const Matrix23d& M, const Eigen::Vector2d& weighted_residual, const Eigen::Vector3d& p) {
    const Eigen::Vector3d m = M.transpose() * weighted_residual;
    for (int i = 0; i < 3; ++i) gradient_.segment<3>(3 * i) += m(i) * p;
  }

  void add_product(const Eigen::Matrix3d& MtWM, const Eigen::Vector3d& p) {
    const std::array<double, 6> a = {MtWM(0, 0), MtWM(0, 1), MtWM(0, 2), MtWM(1, 1), MtWM(1, 2), MtWM(2, 2)};
    const std::array<double, 6> b = {p(0) * p(0), p(0) * p(1), p(0) * p(2),
                                     p(1) * p(1), p(1) * p(2), p(2) * p(2)};
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t k = 0; k < 6; ++k) products_[i][k] += a[i] * b[k];
  }

  /// Over the first eight entries: the ninth, H(2,2), is fixed.
  Matrix8d matrix() const {
    static constexpr std::size_t kPacked[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    Matrix8d N;
    for (int row = 0; row < 8; ++row)
      for (int col = 0; col < 8; ++col)
        N(row, col) = products_[kPacked[row / 3][col / 3]][kPacked[row % 3][col % 3]];
    return N;
  }
  Vector8d gradient() const { return gradient_.head<8>(); }

 private:
  std::array<std::array<double, 6>, 6> products_{};
  Vector9d gradient_ = Vector9d::Zero();
};

/// Tukey's biweight loss of a squared error: nearly linear below the limit, constant above it.
double loss_px2(double error_px2, double limit_px2) {
  if (!(error_px2 < limit_px2)) return limit_px2 / 3.0;
  const double x = error_px2 / limit_px2;
  return error_px2 * (1.0 - x + x * x / 3.0);
}

/// Its derivative: a pair's weight.
double loss_weight(double error_px2, double limit_px2) {
  const double u = std::max(0.0, 1.0 - error_px2 / limit_px2);
  return u * u;
}

double total_loss_px2(std::span<const PointPair> pairs, const Eigen::Matrix3d& H, double limit_px2) {
  const Eigen::Matrix3d H_inverse = H.inverse();
  double sum = 0.0;
  for (const PointPair& pair : pairs)
    sum += loss_px2(symmetric_transfer_error_px2(H, H_inverse, pair), limit_px2);
  return sum;
}

/// Gauss–Newton's equations at H. Backwards, with p = H⁻¹ x_cur: d(H⁻¹ x) = −H⁻¹ dH p.
NormalEquations linearise(std::span<const PointPair> pairs, const Eigen::Matrix3d& H, double limit_px2) {
  const Eigen::Matrix3d H_inverse = H.inverse();
  NormalEquations equations;
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d x = pair.ref_px.homogeneous();
    const Eigen::Vector3d q = H * x;
    const Eigen::Vector2d forward_px = q.hnormalized() - pair.cur_px;
    const Eigen::Vector3d p = H_inverse * pair.cur_px.homogeneous();
    const Eigen::Vector2d backward_px = p.hnormalized() - pair.ref_px;
    const double weight = loss_weight(forward_px.squaredNorm() + backward_px.squaredNorm(), limit_px2);
    if (!(weight > 0.0)) continue;

    const Matrix23d forward = projection_jacobian(q);
    equations.add_product(weight * forward.transpose() * forward, x);
    equations.add_gradient(forward, weight * forward_px, x);
    const Matrix23d backward = -projection_jacobian(p) * H_inverse;
    equations.add_product(weight * backward.transpose() * backward, p);
    equations.add_gradient(backward, weight * backward_px, p);
  }
  return equations;
}

/// The loss over the pairs as the minimiser sees it; H(2,2) stays what it is.
struct LossDescent {
  std::span<const PointPair> pairs;
  double limit_px2;

  double cost(const Eigen::Matrix3d& H) const { return total_loss_px2(pairs, H, limit_px2); }
  GaussNewtonEquations<8> equations(const Eigen::Matrix3d& H) const {
    const NormalEquations sums = linearise(pairs, H, limit_px2);
    return {sums.matrix(), sums.gradient()};
  }
  Eigen::Matrix3d stepped(const Eigen::Matrix3d& H, const Vector8d& step) const {
    Eigen::Matrix3d result = H;
    for (int i = 0; i < 8; ++i) result(i / 3, i % 3) += step(i);
    return result;
  }
};

}  // namespace

double refine_homography(std::span<const PointPair> pairs, double limit_px2,
                         Eigen::Matrix3d& H_cur_from_ref) {
  Eigen::Matrix3d H = H_cur_from_ref / H_cur_from_ref(2, 2);
  if (!H.allFinite()) return total_loss_px2(pairs, H_cur_from_ref, limit_px2);
  const double cost = levenberg_marquardt(LossDescent{pairs, limit_px2}, kHomographyDescent, H);
  H_cur_from_ref = H;
  return cost;
}

// Let r be a pair's forward residual and D the derivative of the backward map, so that the backward residual
// is −D r to first order, and the cost's weight on r is W = I + DᵀD. Noise σ in both images gives r the
// covariance σ² S, S = I + (DᵀD)⁻¹. The minimiser's covariance is σ² N⁻¹ (Σ Jᵀ W S W J) N⁻¹ with N = Σ Jᵀ W
// J.
HomographyPrecision homography_precision(std::span<const PointPair> pairs,
                                         const Eigen::Matrix3d& H_cur_from_ref) {
  HomographyPrecision precision;
  const Eigen::Matrix3d H_inverse = H_cur_from_ref.inverse();
  NormalEquations normal, spread;
  double whitened = 0.0, forward_px2 = 0.0;
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d x = pair.ref_px.homogeneous();
    const Eigen::Vector3d q = H_cur_from_ref * x;
    const Matrix23d J = projection_jacobian(q);
    const Eigen::Vector2d r = q.hnormalized() - pair.cur_px;
    const Eigen::Vector3d p = H_inverse * pair.cur_px.homogeneous();
    const Eigen::Matrix2d D = (projection_jacobian(p) * H_inverse).leftCols<2>();
    const Eigen::Matrix2d DtD = D.transpose() * D;
    const Eigen::Matrix2d W = Eigen::Matrix2d::Identity() + DtD;
    const Eigen::Matrix2d S = Eigen::Matrix2d::Identity() + DtD.inverse();
    normal.add_product(J.transpose() * W * J, x);
    spread.add_product(J.transpose() * (W * S * W) * J, x);
    whitened += r.dot(S.inverse() * r);
    forward_px2 += r.squaredNorm();
  }
  const double n = static_cast<double>(pairs.size());
  const double variance = whitened / std::max(1.0, 2.0 * n - 8.0);
  const Matrix8d inverse = normal.matrix().inverse();
  precision.covariance.topLeftCorner<8, 8>() = variance * inverse * spread.matrix() * inverse;
  precision.noise_px = std::sqrt(variance);
  precision.rms_px = std::sqrt(forward_px2 / n);
  return precision;
}

}  // namespace heel
