// Levenberg–Marquardt: Gauss–Newton steps, damped along the diagonal until one lowers the cost (Marquardt
// 1963).
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace heel {

/// Of the cost Σ rᵀ W r about one x: Gauss–Newton's equations N dx = −gradient, with N = Σ Jᵀ W J and
/// gradient = Σ Jᵀ W r.
template <int Size>
struct GaussNewtonEquations {
  double cost = 0.0;
  Eigen::Matrix<double, Size, Size> N = Eigen::Matrix<double, Size, Size>::Zero();
  Eigen::Matrix<double, Size, 1> gradient = Eigen::Matrix<double, Size, 1>::Zero();
};

struct DescentLimits {
  int max_steps = 30;
  double converged = 1e-8;    ///< relative decrease of the cost below which it ends
  double max_damping = 1e10;  ///< beyond it no step helps any more
};

/// Lowers the cost from the given `x` on; returns the cost reached, and x there. The problem offers
///   GaussNewtonEquations<Size> equations(const X&);  X stepped(const X&, const Vector&);
/// Nearly every step is taken, so the equations are made along with the cost of each.
template <typename Problem, typename X>
double levenberg_marquardt(const Problem& problem, const DescentLimits& limits, X& x) {
  auto here = problem.equations(x);
  double damping = 1e-4;
  for (int step = 0; step < limits.max_steps && damping < limits.max_damping; ++step) {
    double decrease = 0.0;
    bool improved = false;
    while (!improved && damping < limits.max_damping) {
      auto damped = here.N;
      damped.diagonal() *= 1.0 + damping;
      const X trial = problem.stepped(x, damped.ldlt().solve(-here.gradient));
      const auto there = problem.equations(trial);
      improved = there.cost < here.cost;
      if (improved) {
        decrease = here.cost - there.cost;
        here = there;
        x = trial;
        damping *= 0.1;
      } else {
        damping *= 10.0;
      }
    }
    if (decrease <= limits.converged * here.cost) break;
  }
  return here.cost;
}

}  // namespace heel
