#include "vision/homography/homography_refine.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vision/optimisation/levenberg_marquardt.h"
#include "vision/optimisation/projection.h"

namespace heel {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Vector8d = Eigen::Matrix<double, 8, 1>;

// Converged when the decrease is far below the effect of noise on the cost.
constexpr DescentLimits kHomographyDescent{.max_steps = 20, .converged = 1e-5, .max_damping = 1e8};

/// The upper half of a symmetric 3 × 3 matrix, row by row.
using Symmetric3 = std::array<double, 6>;

Symmetric3 symmetric_part(const Eigen::Matrix3d& A) {
  return {A(0, 0), A(0, 1), A(0, 2), A(1, 1), A(1, 2), A(2, 2)};
}

// If a residual depends on a 3 × 3 matrix Q only through Q p, its derivative with respect to the row-major
// entries of Q is M ⊗ pᵀ with M (2 × 3). Its normal matrix Mᵀ W M ⊗ p pᵀ is a product of two symmetric 3 × 3
// matrices, which has 36 different numbers instead of 81. These are summed.
class NormalEquations {
 public:
  void add_gradient(const Eigen::Vector3d& MtWr, const Eigen::Vector3d& p) {
    for (int i = 0; i < 3; ++i) gradient_.segment<3>(3 * i) += MtWr(i) * p;
  }

  void add_product(const Symmetric3& MtWM, const Eigen::Vector3d& p) {
    const Symmetric3 ppt = {p(0) * p(0), p(0) * p(1), p(0) * p(2), p(1) * p(1), p(1) * p(2), p(2) * p(2)};
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t k = 0; k < 6; ++k) products_[i][k] += MtWM[i] * ppt[k];
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

/// The derivative of the loss: the weight of a pair.
double loss_weight(double error_px2, double limit_px2) {
  const double u = std::max(0.0, 1.0 - error_px2 / limit_px2);
  return u * u;
}

/// The loss over the pairs as a problem for levenberg_marquardt; H(2,2) is constant.
struct LossDescent {
  std::span<const PointPair> pairs;
  double limit_px2;

  /// The backward direction uses d(H⁻¹ x) = −H⁻¹ dH p with p = H⁻¹ x_cur.
  GaussNewtonEquations<8> equations(const Eigen::Matrix3d& H) const {
    const Eigen::Matrix3d H_inverse = H.inverse();
    NormalEquations sums;
    double loss = 0.0;
    for (const PointPair& pair : pairs) {
      const Eigen::Vector3d x = pair.ref_px.homogeneous();
      const Eigen::Vector3d q = H * x;
      const Eigen::Vector2d forward_px = q.hnormalized() - pair.cur_px;
      const Eigen::Vector3d p = H_inverse * pair.cur_px.homogeneous();
      const Eigen::Vector2d backward_px = p.hnormalized() - pair.ref_px;
      const double error_px2 = forward_px.squaredNorm() + backward_px.squaredNorm();
      loss += loss_px2(error_px2, limit_px2);
      const double weight = loss_weight(error_px2, limit_px2);
      if (!(weight > 0.0)) continue;

      // Forward: M = J, the derivative of the projection. JᵀJ consists mostly of zeros and ones.
      const double i = 1.0 / q.z(), u = q.x() * i, v = q.y() * i, wii = weight * i * i;
      sums.add_product({wii, 0.0, -wii * u, wii, -wii * v, wii * (u * u + v * v)}, x);
      const Eigen::Vector2d weighted = weight * i * forward_px;
      sums.add_gradient({weighted.x(), weighted.y(), -u * weighted.x() - v * weighted.y()}, x);
      // Backward: M = −J H⁻¹.
      const Matrix23d M = -projection_jacobian(p) * H_inverse;
      const Eigen::Vector3d m0 = M.row(0), m1 = M.row(1), w0 = weight * m0, w1 = weight * m1;
      sums.add_product({w0.x() * m0.x() + w1.x() * m1.x(), w0.x() * m0.y() + w1.x() * m1.y(),
                        w0.x() * m0.z() + w1.x() * m1.z(), w0.y() * m0.y() + w1.y() * m1.y(),
                        w0.y() * m0.z() + w1.y() * m1.z(), w0.z() * m0.z() + w1.z() * m1.z()},
                       p);
      sums.add_gradient(backward_px.x() * w0 + backward_px.y() * w1, p);
    }
    return {loss, sums.matrix(), sums.gradient()};
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
  if (!H.allFinite()) return std::numeric_limits<double>::infinity();
  const double cost = levenberg_marquardt(LossDescent{pairs, limit_px2}, kHomographyDescent, H);
  H_cur_from_ref = H;
  return cost;
}

// Let r be the forward residual of a pair and D the derivative of the backward map. To first order the
// backward residual is −D r, and the cost gives r the weight W = I + DᵀD. Noise σ in both images gives r the
// covariance σ² S with S = I + (DᵀD)⁻¹. The covariance of the minimiser is σ² N⁻¹ (Σ Jᵀ W S W J) N⁻¹ with N =
// Σ Jᵀ W J.
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
    normal.add_product(symmetric_part(J.transpose() * W * J), x);
    spread.add_product(symmetric_part(J.transpose() * (W * S * W) * J), x);
    whitened += r.dot(S.inverse() * r);
    forward_px2 += r.squaredNorm();
  }
  const double n = static_cast<double>(pairs.size());
  const double variance = whitened / std::max(1.0, 2.0 * n - 8.0);
  const Matrix8d inverse = normal.matrix().ldlt().solve(Matrix8d::Identity());
  precision.covariance.topLeftCorner<8, 8>() = variance * inverse * spread.matrix() * inverse;
  precision.noise_px = std::sqrt(variance);
  precision.rms_px = std::sqrt(forward_px2 / n);
  return precision;
}

}  // namespace heel
