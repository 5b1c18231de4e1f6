#include "sim/pose_noise/error_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "core/angles.h"
#include "heel/error.h"

namespace heel::sim {
namespace {

constexpr std::size_t kMinRows = 200;
constexpr int kRobustRounds = 8;
constexpr double kHuber = 2.5;       ///< normalised residuals beyond this get less weight
constexpr double kRidge = 1e-5;      ///< ridge of a linear fit, per unit of weight
constexpr double kOddsRidge = 0.05;  ///< ridge of a logistic fit; rare events do not determine all terms
constexpr int kNewtonSteps = 60;
constexpr double kBackHalfWidth_m = 0.16;
constexpr double kMinSpread = 1e-5;
constexpr double kAspectMargin_rad = 0.05, kDistanceMargin_m = 0.1;

constexpr auto kEven = static_cast<Eigen::Index>(kEvenTerms.size());
constexpr auto kOdd = static_cast<Eigen::Index>(kOddTerms.size());

using Rows = std::vector<const FitRow*>;

Eigen::MatrixXd even_matrix(const Rows& rows) {
  Eigen::MatrixXd A(static_cast<Eigen::Index>(rows.size()), kEven);
  for (std::size_t i = 0; i < rows.size(); ++i)
    A.row(static_cast<Eigen::Index>(i)) = even_terms(rows[i]->conditions).transpose();
  return A;
}

/// Weighted least squares with a small ridge, so that a term without data stays at zero.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                              const Eigen::VectorXd& weights) {
  const double ridge = kRidge * weights.sum();
  Eigen::MatrixXd N = A.transpose() * weights.asDiagonal() * A;
  N.diagonal().array() += ridge;
  return N.ldlt().solve(A.transpose() * (weights.asDiagonal() * b));
}

/// Newton's method on the ridge-penalised likelihood.
EvenTerms logistic_regression(const Rows& rows, const std::vector<bool>& happened) {
  const Eigen::MatrixXd A = even_matrix(rows);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(kEven);
  const auto count = std::count(happened.begin(), happened.end(), true);
  w(0) = std::log((static_cast<double>(count) + 0.5) /
                  (static_cast<double>(rows.size() - static_cast<std::size_t>(count)) + 0.5));
  for (int step = 0; step < kNewtonSteps; ++step) {
    Eigen::VectorXd gradient = -kOddsRidge * w;
    gradient(0) = 0.0;  // no ridge for the constant term
    Eigen::MatrixXd N = kOddsRidge * Eigen::MatrixXd::Identity(kEven, kEven);
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      const double p = 1.0 / (1.0 + std::exp(-A.row(i).dot(w)));
      gradient += ((happened[static_cast<std::size_t>(i)] ? 1.0 : 0.0) - p) * A.row(i).transpose();
      N += std::max(p * (1.0 - p), 1e-9) * A.row(i).transpose() * A.row(i);
    }
    const Eigen::VectorXd change = N.ldlt().solve(gradient);
    w += change * std::min(1.0, 3.0 / std::max(change.norm(), 1e-12));
    if (change.norm() < 1e-8) break;
  }
  return w;
}

Quantiles quantiles_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Quantiles out;
  for (std::size_t i = 0; i < kQuantiles; ++i) {
    const double at = static_cast<double>(i) / (kQuantiles - 1) * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    out[i] = values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
  }
  return out;
}

/// The share of the variance that is between worlds (analysis of variance, random effects).
double share_between_worlds(const Rows& rows, const Eigen::VectorXd& residual) {
  std::map<std::uint64_t, std::vector<double>> worlds;
  for (std::size_t i = 0; i < rows.size(); ++i)
    worlds[rows[i]->world].push_back(residual(static_cast<Eigen::Index>(i)));
  if (worlds.size() < 2) return 0.0;
  const double mean = residual.mean();
  double between = 0.0, within = 0.0, squares = 0.0;
  const auto n = static_cast<double>(rows.size());
  for (const auto& [world, values] : worlds) {
    const auto size = static_cast<double>(values.size());
    double sum = 0.0;
    for (const double value : values) sum += value;
    between += size * std::pow(sum / size - mean, 2);
    for (const double value : values) within += std::pow(value - sum / size, 2);
    squares += size * size;
  }
  const auto groups = static_cast<double>(worlds.size());
  const double mean_between = between / (groups - 1.0), mean_within = within / (n - groups);
  const double size0 = (n - squares / n) / (groups - 1.0);
  const double variance = std::max(0.0, (mean_between - mean_within) / size0);
  return variance / std::max(variance + mean_within, 1e-12);
}

/// The lag at which the autocorrelation of a sequence around its mean falls below 1/e; 0 for a short
/// sequence.
double correlation_time_s(const std::vector<double>& t_s, std::vector<double> values) {
  if (values.size() < 30) return 0.0;
  double mean = 0.0, power = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (double& value : values) {
    value -= mean;
    power += value * value / static_cast<double>(values.size());
  }
  if (power <= 0.0) return 0.0;
  const double period_s = (t_s.back() - t_s.front()) / static_cast<double>(t_s.size() - 1);
  const std::size_t half = values.size() / 2;
  for (std::size_t lag = 1; lag < half; ++lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < values.size(); ++i) product += values[i] * values[i - lag];
    product /= static_cast<double>(values.size() - lag);
    if (product < power / M_E) return static_cast<double>(lag) * period_s;
  }
  return static_cast<double>(half) * period_s;
}

/// Fits the bias by robust least squares and the spread to the logarithm of the residuals, alternating.
SpreadModel fit_spread(const Rows& rows, const Rows& walk, double FitRow::*error, bool with_side) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  const Eigen::MatrixXd even = even_matrix(rows);
  Eigen::MatrixXd A(count, with_side ? kOdd : kEven);
  Eigen::VectorXd b(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const FitRow& row = *rows[static_cast<std::size_t>(i)];
    if (with_side)
      A.row(i) = odd_terms(row.conditions).transpose();
    else
      A.row(i) = even.row(i);
    b(i) = row.*error;
  }
  SpreadModel model;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(count), residual = b;
  for (int round = 0; round < kRobustRounds; ++round) {
    const Eigen::VectorXd solution = least_squares(A, b, weights);
    residual = b - A * solution;
    const Eigen::VectorXd log_size = (residual.array().abs() + kMinSpread).log();
    model.log_spread = least_squares(even, log_size, Eigen::VectorXd::Ones(count));
    if (with_side)
      model.bias_odd = solution;
    else
      model.bias_even = solution;
    // The mean logarithm is below the logarithm of the deviation, but for the weights only proportions
    // matter.
    const Eigen::VectorXd spread = (even * model.log_spread).array().exp();
    for (Eigen::Index i = 0; i < count; ++i) {
      const double normalised = std::abs(residual(i)) / (2.0 * spread(i));
      weights(i) = std::min(1.0, kHuber / std::max(normalised, 1e-9)) / (spread(i) * spread(i));
    }
  }
  const Eigen::VectorXd normalised = residual.array() / (even * model.log_spread).array().exp();
  model.residual = quantiles_of({normalised.data(), normalised.data() + count});
  // The variance is that of the residuals without the tails, which have few samples.
  const double limit = std::max(std::abs(model.residual[1]), std::abs(model.residual[kQuantiles - 2]));
  model.print_share = share_between_worlds(rows, normalised.cwiseMin(limit).cwiseMax(-limit));
  std::vector<double> t_s, sequence;
  for (const FitRow* row : walk) {
    t_s.push_back(row->t_s);
    sequence.push_back((row->*error - model.bias(row->conditions)) / model.spread(row->conditions));
  }
  model.memory_s = correlation_time_s(t_s, sequence);
  return model;
}

LogModel fit_log(const Rows& rows, const std::function<double(const FitRow&)>& value) {
  Eigen::VectorXd b(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    b(static_cast<Eigen::Index>(i)) = std::log(std::max(value(*rows[i]), 1e-6));
  const Eigen::MatrixXd A = even_matrix(rows);
  LogModel model;
  model.log_mean = least_squares(A, b, Eigen::VectorXd::Ones(b.size()));
  const Eigen::VectorXd residual = b - A * model.log_mean;
  model.log_deviation = std::sqrt(residual.squaredNorm() / static_cast<double>(b.size()));
  return model;
}

void fit_time(const std::vector<FitRow>& pictures, const Rows& found, ErrorModel& model) {
  model.time_share = fit_log(found, [](const FitRow& row) { return row.vision_ms; });
  const double reference = model.time_share.mean_log(ViewConditions{});
  model.time_share.log_mean(0) -= reference;
  double sum = 0.0;
  int missed = 0;
  for (const FitRow& row : pictures) {
    if (row.found) continue;
    sum += std::log(std::max(row.vision_ms, 1e-3)) - reference;
    ++missed;
  }
  model.missed_log_time_share = missed > 0 ? sum / missed : 0.0;
}

/// The pictures by their result.
struct Selection {
  Rows all, found, not_flipped;
  std::vector<bool> is_found;    ///< of all
  std::vector<bool> is_flipped;  ///< of the found
};

Selection select(const std::vector<FitRow>& pictures) {
  Selection selection;
  for (const FitRow& row : pictures) {
    selection.all.push_back(&row);
    selection.is_found.push_back(row.found);
    if (!row.found) continue;
    selection.found.push_back(&row);
    selection.is_flipped.push_back(row.flipped);
    if (!row.flipped) selection.not_flipped.push_back(&row);
  }
  return selection;
}

/// The range of the pictures in which the shirt was found.
void set_limits(const Rows& found, ErrorModel& model) {
  for (const FitRow* row : found) {
    model.distance_max_m = std::max(model.distance_max_m, row->conditions.distance_m + kDistanceMargin_m);
    model.aspect_max_rad =
        std::max(model.aspect_max_rad, std::abs(row->conditions.aspect_rad) + kAspectMargin_rad);
  }
}

}  // namespace

ErrorModel fit_error_model(const std::vector<FitRow>& pictures, const std::vector<FitRow>& walk) {
  const Selection selection = select(pictures);
  if (selection.not_flipped.size() < kMinRows)
    throw Error(fmt::format("error model: the shirt was found in {} of {} pictures (expected at least {})",
                            selection.not_flipped.size(), pictures.size(), kMinRows));
  Rows walk_found;
  std::vector<double> walk_t_s, walk_miss;
  for (const FitRow& row : walk) {
    walk_t_s.push_back(row.t_s);
    walk_miss.push_back(row.found ? 0.0 : 1.0);
    if (row.found && !row.flipped) walk_found.push_back(&row);
  }
  ErrorModel model;
  set_limits(selection.found, model);
  model.found_log_odds = logistic_regression(selection.all, selection.is_found);
  model.flip_log_odds = logistic_regression(selection.found, selection.is_flipped);
  model.aspect_rad = fit_spread(selection.not_flipped, walk_found, &FitRow::aspect_error_rad, true);
  model.range_share = fit_spread(selection.not_flipped, walk_found, &FitRow::range_error_share, false);
  model.bearing_rad = fit_spread(selection.not_flipped, walk_found, &FitRow::bearing_error_rad, true);
  model.certainty = fit_log(selection.found, [](const FitRow& row) { return row.certainty; });
  model.yaw_sigma_rad = fit_log(selection.not_flipped, [](const FitRow& row) { return row.yaw_sigma_rad; });
  fit_time(pictures, selection.found, model);
  // Without any missed frame, misses are correlated like errors.
  const double misses_s = correlation_time_s(walk_t_s, walk_miss);
  model.found_memory_s = misses_s > 0.0 ? misses_s : model.aspect_rad.memory_s;
  return model;
}

ViewConditions conditions_of(double x_m, double z_m, double yaw_rad, double fx_px, double cx_px,
                             double width_px, double occluded) {
  ViewConditions conditions;
  conditions.distance_m = std::hypot(x_m, z_m);
  conditions.aspect_rad = wrap_angle_rad(yaw_rad - std::atan2(x_m, z_m));
  conditions.hidden = occluded;
  // The part out of the picture counts as hidden.
  const double half_px = std::max(
      1.0, fx_px * kBackHalfWidth_m * std::abs(std::cos(conditions.aspect_rad)) / std::max(z_m, 0.1));
  const double at_px = cx_px + fx_px * x_m / std::max(z_m, 0.1);
  const double out_left = std::clamp((half_px - at_px) / (2.0 * half_px), 0.0, 1.0);
  const double out_right = std::clamp((at_px + half_px - width_px) / (2.0 * half_px), 0.0, 1.0);
  if (out_left > std::abs(conditions.hidden)) conditions.hidden = out_left;
  if (out_right > std::abs(conditions.hidden)) conditions.hidden = -out_right;
  return conditions;
}

}  // namespace heel::sim
