// Levenberg–Marquardt: Gauss–Newton steps whose diagonal is damped until a step lowers the cost.
//
// Convention: the cost is Σ rᵀ W r; an increment dx is applied by the problem itself. Units: those of the
// problem.
// Source: D. Marquardt, "An algorithm for least-squares estimation of nonlinear parameters", SIAM J. 11(2),
// 1963.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace heel {

/// The Gauss–Newton equations N dx = −gradient at one x, with N = Σ Jᵀ W J and gradient = Σ Jᵀ W r.
template <int Size>
struct GaussNewtonEquations {
  double cost = 0.0;
  Eigen::Matrix<double, Size, Size> N = Eigen::Matrix<double, Size, Size>::Zero();
  Eigen::Matrix<double, Size, 1> gradient = Eigen::Matrix<double, Size, 1>::Zero();
};

struct DescentLimits {
  int max_steps = 30;
  double converged = 1e-8;    ///< ends when the relative decrease of the cost is smaller
  double max_damping = 1e10;  ///< ends when the damping is larger: no step lowers the cost
};

/// Lowers the cost, starting from `x`; returns the cost reached and replaces `x`. The problem has the members
///   GaussNewtonEquations<Size> equations(const X&);
///   X stepped(const X&, const Vector&);
/// The equations are computed together with the cost of a trial step, since nearly every step is accepted.
template <typename Problem, typename X>
double levenberg_marquardt(const Problem& problem, const DescentLimits& limits, X& x) {
  auto current = problem.equations(x);
  double damping = 1e-4;
  for (int step = 0; step < limits.max_steps && damping < limits.max_damping; ++step) {
    double decrease = 0.0;
    bool improved = false;
    while (!improved && damping < limits.max_damping) {
      auto damped = current.N;
      damped.diagonal() *= 1.0 + damping;
      const X trial = problem.stepped(x, damped.ldlt().solve(-current.gradient));
      const auto next = problem.equations(trial);
      improved = next.cost < current.cost;
      if (improved) {
        decrease = current.cost - next.cost;
        current = next;
        x = trial;
        damping *= 0.1;
      } else {
        damping *= 10.0;
      }
    }
    if (decrease <= limits.converged * current.cost) break;
  }
  return current.cost;
}

}  // namespace heel
