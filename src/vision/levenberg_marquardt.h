// Levenberg–Marquardt: Gauss–Newton steps, damped along the diagonal until one lowers the cost (Marquardt
// 1963).
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace heel {

/// Gauss–Newton's equations N dx = −gradient, with N = Σ Jᵀ W J and gradient = Σ Jᵀ W r.
template <int Size>
struct GaussNewtonEquations {
  Eigen::Matrix<double, Size, Size> N = Eigen::Matrix<double, Size, Size>::Zero();
  Eigen::Matrix<double, Size, 1> gradient = Eigen::Matrix<double, Size, 1>::Zero();
};

struct DescentLimits {
  int max_steps = 30;
  double converged = 1e-8;    ///< relative decrease of the cost below which it ends
  double max_damping = 1e10;  ///< beyond it no step helps any more
};

/// Lowers `problem.cost(x)` from the given `x` on; returns the cost reached, and x there. The problem offers
///   double cost(const X&);  GaussNewtonEquations<Size> equations(const X&);  X stepped(const X&, const
///   Vector&).
template <typename Problem, typename X>
double levenberg_marquardt(const Problem& problem, const DescentLimits& limits, X& x) {
  double cost = problem.cost(x);
  double damping = 1e-4;
  for (int step = 0; step < limits.max_steps && damping < limits.max_damping; ++step) {
    const auto equations = problem.equations(x);
    double decrease = 0.0;
    bool improved = false;
    while (!improved && damping < limits.max_damping) {
      auto damped = equations.N;
      damped.diagonal() *= 1.0 + damping;
      const X trial = problem.stepped(x, damped.ldlt().solve(-equations.gradient));
      const double trial_cost = problem.cost(trial);
      improved = trial_cost < cost;
      if (improved) {
        decrease = cost - trial_cost;
        cost = trial_cost;
        x = trial;
        damping *= 0.1;
      } else {
        damping *= 10.0;
      }
    }
    if (decrease <= limits.converged * cost) break;
  }
  return cost;
}

}  // namespace heel
