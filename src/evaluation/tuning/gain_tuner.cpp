#include "evaluation/tuning/gain_tuner.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

namespace heel::evaluation {
namespace {

constexpr double kFirstStep = 0.35;  // natural logarithm: 40 %
constexpr double kLastStep = 0.005;

/// A search that NLopt calls back; exceptions do not pass through C.
class Search {
 public:
  Search(std::span<const TunedKey> keys, const std::vector<double>& start, const Cost& cost,
         const GoOn& go_on)
      : keys_(keys), start_(start), cost_(cost), go_on_(go_on) {}

  std::vector<SearchStep> run(int most_steps) {
    const auto count = static_cast<unsigned>(keys_.size());
    std::vector<double> x(count, 0.0), low(count), high(count);
    for (unsigned i = 0; i < count; ++i) {
      const auto [least, most] =
          std::minmax({std::log(keys_[i].low / start_[i]), std::log(keys_[i].high / start_[i])});
      low[i] = std::min(0.0, least);
      high[i] = std::max(0.0, most);
    }
    optimiser_.reset(nlopt_create(NLOPT_LN_SBPLX, count));
    nlopt_set_lower_bounds(optimiser_.get(), low.data());
    nlopt_set_upper_bounds(optimiser_.get(), high.data());
    nlopt_set_initial_step1(optimiser_.get(), kFirstStep);
    nlopt_set_xtol_abs1(optimiser_.get(), kLastStep);
    nlopt_set_maxeval(optimiser_.get(), most_steps);
    nlopt_set_min_objective(optimiser_.get(), &Search::evaluate, this);
    double least = 0.0;
    nlopt_optimize(optimiser_.get(), x.data(), &least);
    if (error_) std::rethrow_exception(error_);
    return std::move(steps_);
  }

 private:
  struct Destroy {
    void operator()(nlopt_opt optimiser) const { nlopt_destroy(optimiser); }
  };

  static double evaluate(unsigned count, const double* x, double* /*gradient*/, void* self) {
    return static_cast<Search*>(self)->step({x, count});
  }

  double step(std::span<const double> x) {
    try {
      SearchStep step;
      for (std::size_t i = 0; i < x.size(); ++i)
        step.values.push_back(std::clamp(start_[i] * std::exp(x[i]), keys_[i].low, keys_[i].high));
      step.cost = cost_(step.values);
      step.least_cost = steps_.empty() ? step.cost : std::min(step.cost, steps_.back().least_cost);
      steps_.push_back(step);
      if (!go_on_(step)) nlopt_force_stop(optimiser_.get());
      return step.cost;
    } catch (...) {
      error_ = std::current_exception();
      nlopt_force_stop(optimiser_.get());
      return 0.0;
    }
  }

  std::span<const TunedKey> keys_;
  const std::vector<double>& start_;
  const Cost& cost_;
  const GoOn& go_on_;
  std::unique_ptr<std::remove_pointer_t<nlopt_opt>, Destroy> optimiser_;
  std::vector<SearchStep> steps_;
  std::exception_ptr error_;
};

}  // namespace

std::vector<SearchStep> search(std::span<const TunedKey> keys, const std::vector<double>& start,
                               const Cost& cost, int most_steps, const GoOn& go_on) {
  return Search(keys, start, cost, go_on).run(most_steps);
}

const SearchStep& best_step(const std::vector<SearchStep>& steps) {
  return *std::ranges::min_element(steps, {}, &SearchStep::cost);
}

}  // namespace heel::evaluation
