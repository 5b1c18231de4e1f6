// O. Faugeras and F. Lustman, "Motion and structure from motion in a piecewise planar environment", IJPRAI
// 2(3), 1988 (INRIA RR-0856). The paper writes A = d R + t nᵀ and solves it in the frames of A = U Λ Vᵀ:
//   Λ = d' R' + t' n'ᵀ,  R = s U R' Vᵀ,  t = U t',  n = V n',  d = s d',  s = det U det V,  d' = ±d2.
// Here A is first scaled so that d2 = 1 and signed so that det A > 0; then s = 1 and d' = ±1. With d' = +1
// both cameras are on the same side of the plane; d' = −1 decomposes −A and has them on different sides.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "heel/motion.h"

namespace heel {
namespace {

/// A = U diag(d) Vᵀ with d2 = 1.
struct Svd {
  Eigen::Matrix3d U, V;
  Eigen::Vector3d d;
};

struct Solution {
  Eigen::Matrix3d R;  // R' of the paper
  Eigen::Vector3d t;  // t'
};

/// Case d' > 0.
Solution same_side_solution(const Eigen::Vector3d& d, double x1, double x3) {
  const double sin_theta = (d(0) - d(2)) * x1 * x3 / d(1);            // Eq. (13)
  const double cos_theta = (d(0) * x3 * x3 + d(2) * x1 * x1) / d(1);  // Eq. (13)
  Solution solution;
  solution.R << cos_theta, 0.0, -sin_theta, 0.0, 1.0, 0.0, sin_theta, 0.0, cos_theta;
  solution.t = (d(0) - d(2)) * Eigen::Vector3d(x1, 0.0, -x3);  // Eq. (14)
  return solution;
}

/// Case d' < 0.
Solution opposite_side_solution(const Eigen::Vector3d& d, double x1, double x3) {
  const double sin_phi = (d(0) + d(2)) * x1 * x3 / d(1);            // Eq. (15)
  const double cos_phi = (d(2) * x1 * x1 - d(0) * x3 * x3) / d(1);  // Eq. (15)
  Solution solution;
  solution.R << cos_phi, 0.0, sin_phi, 0.0, -1.0, 0.0, sin_phi, 0.0, -cos_phi;
  solution.t = (d(0) + d(2)) * Eigen::Vector3d(x1, 0.0, x3);  // Eq. (16)
  return solution;
}

void add(PlaneMotions& motions, const Svd& svd, const Solution& solution, double x1, double x3,
         bool same_side) {
  PlaneMotion& motion = motions.motions[static_cast<std::size_t>(motions.count++)];
  const double d_prime = same_side ? 1.0 : -1.0;
  motion.R_cur_from_ref = svd.U * solution.R * svd.V.transpose();
  motion.t_over_d = svd.U * solution.t / d_prime;
  motion.normal_ref = svd.V * Eigen::Vector3d(x1, 0.0, x3);
  motion.same_side = same_side;
}

/// All signs of n' = (x1, 0, x3), in both cases of d'. A zero has one sign only.
void add_all_signs(PlaneMotions& motions, const Svd& svd, double x1, double x3) {
  for (const bool same_side : {true, false}) {
    for (const double e1 : {1.0, -1.0}) {
      for (const double e3 : {1.0, -1.0}) {
        if ((x1 == 0.0 && e1 < 0.0) || (x3 == 0.0 && e3 < 0.0)) continue;
        const Solution solution = same_side ? same_side_solution(svd.d, e1 * x1, e3 * x3)
                                            : opposite_side_solution(svd.d, e1 * x1, e3 * x3);
        add(motions, svd, solution, e1 * x1, e3 * x3, same_side);
      }
    }
  }
}

}  // namespace

PlaneMotions decompose_plane_motion(const Eigen::Matrix3d& A, double relative_tolerance) {
  PlaneMotions motions;
  if (!A.allFinite()) return motions;
  const double sign = A.determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::JacobiSVD<Eigen::Matrix3d> decomposition(sign * A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  // A copy: with a reference GCC 12 warns of an uninitialised value.
  // NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
  const Eigen::Vector3d singular = decomposition.singularValues();
  if (!(singular(2) > relative_tolerance * singular(0)))
    return motions;  // singular: the plane is seen edge-on
  const Svd svd{decomposition.matrixU(), decomposition.matrixV(), singular / singular(1)};

  const double d1 = svd.d(0), d2 = svd.d(1), d3 = svd.d(2);
  const double range = (d1 - d3) * (d1 + d3);
  if (d1 - d3 <= relative_tolerance * d2) {
    // d1 = d2 = d3, d' > 0: R' = I, t' = 0, n' undetermined. (With d' < 0 the second camera would be the
    // mirror image of the first in an undetermined plane.)
    motions.kind = PlaneMotionCase::PureRotation;
    motions.count = 1;
    motions.motions[0].R_cur_from_ref = svd.U * svd.V.transpose();
    return motions;
  }
  double x1 = std::sqrt((d1 - d2) * (d1 + d2) / range);  // Eq. (12)
  double x3 = std::sqrt((d2 - d3) * (d2 + d3) / range);  // Eq. (12)
  // x1 and x3 grow with the square root of the gap between two singular values. The tolerance is applied to
  // them, not to the gap: so the error at the boundary of a case is of the order of the tolerance, not of its
  // square root.
  motions.kind = PlaneMotionCase::Distinct;
  if (x1 <= relative_tolerance) {
    motions.kind = PlaneMotionCase::TwoEqual;
    x1 = 0.0;
    x3 = 1.0;
  } else if (x3 <= relative_tolerance) {
    motions.kind = PlaneMotionCase::TwoEqual;
    x1 = 1.0;
    x3 = 0.0;
  }
  add_all_signs(motions, svd, x1, x3);
  return motions;
}

double yaw_of_rotation(const Eigen::Matrix3d& R_cur_from_ref) {
  return std::atan2(R_cur_from_ref(0, 2), R_cur_from_ref(2, 2));
}

}  // namespace heel
