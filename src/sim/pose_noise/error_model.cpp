#include "sim/pose_noise/error_model.h"

#include <algorithm>
#include <cmath>

namespace heel::sim {
namespace {

constexpr double kNearest_m = 0.8, kFarthest_m = 5.6;
constexpr double kWidest_rad = 1.4;
constexpr double kMostBlur_px = 10.0, kDarkest = 4.1;

double logistic(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace

EvenTerms even_terms(const ViewConditions& c) {
  const double r = std::clamp(c.distance_m, kNearest_m, kFarthest_m);
  const double a = std::min(std::abs(c.aspect_rad), kWidest_rad);
  const double blur = std::clamp(c.blur_px, 0.0, kMostBlur_px);
  const double dark = std::clamp(-std::log2(std::max(c.light, 1e-3)), 0.0, kDarkest);
  const double hidden = std::min(std::abs(c.hidden), 1.0);
  EvenTerms terms;
  terms << 1.0, r, r * r, a * a, a * a * a * a, r * a * a, blur, blur * r, dark, dark * dark, hidden,
      hidden * hidden, c.whole_frame_search ? 1.0 : 0.0, c.other_print ? 1.0 : 0.0;
  return terms;
}

OddTerms odd_terms(const ViewConditions& c) {
  const double r = std::clamp(c.distance_m, kNearest_m, kFarthest_m);
  const double a = std::clamp(c.aspect_rad, -kWidest_rad, kWidest_rad);
  const double hidden = std::clamp(c.hidden, -1.0, 1.0);
  OddTerms terms;
  terms << a, a * a * a, a * a * a * a * a, r * a, r * a * a * a, hidden, hidden * std::abs(hidden);
  return terms;
}

double SpreadModel::bias(const ViewConditions& conditions) const {
  return bias_even.dot(even_terms(conditions)) + bias_odd.dot(odd_terms(conditions));
}

double SpreadModel::spread(const ViewConditions& conditions) const {
  return std::exp(log_spread.dot(even_terms(conditions)));
}

double ErrorModel::found_probability(const ViewConditions& conditions) const {
  if (conditions.distance_m > distance_max_m || std::abs(conditions.aspect_rad) > aspect_max_rad) return 0.0;
  return logistic(found_log_odds.dot(even_terms(conditions)));
}

double ErrorModel::flip_probability(const ViewConditions& conditions) const {
  return logistic(flip_log_odds.dot(even_terms(conditions)));
}

}  // namespace heel::sim
