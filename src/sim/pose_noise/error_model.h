// What vision makes of the pictured person, as a model: whether the shirt is found, how certain, how far off,
// how spread, how honest, how quick, by the conditions it is seen under. Every quantity is a sum of few terms
// with fitted weights, so that the file can be read; the shape of the spread is kept as quantiles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace heel::sim {

/// The conditions of one picture.
struct ViewConditions {
  double distance_m = 2.0;  ///< camera to the middle of the back, on the floor
  double aspect_rad = 0.0;  ///< of the back to the line of sight, signed as PoseEstimate::yaw_rad
  double blur_px = 0.0;     ///< length of the smear
  double light = 1.0;       ///< level; the template is taught at 1
  double hidden =
      0.0;  ///< share of the back's width hidden or out of the picture, from its left edge; negative: right
  bool first_look = false;   ///< not found in the frame before: the whole frame is searched
  bool other_print = false;  ///< not the bold shirt
};

/// Terms that are the same for either side.
inline constexpr std::array kEvenTerms{
    "one",           "distance", "distance2", "angle2", "angle4",  "distance_angle2", "blur",
    "blur_distance", "dark",     "dark2",     "hidden", "hidden2", "first_look",      "other_print"};
/// Terms that change sign with the side.
inline constexpr std::array kOddTerms{"angle",           "angle3",      "angle5",      "distance_angle",
                                      "distance_angle3", "hidden_side", "hidden2_side"};

using EvenTerms = Eigen::Matrix<double, kEvenTerms.size(), 1>;
using OddTerms = Eigen::Matrix<double, kOddTerms.size(), 1>;

/// Distances in metres, angles in radians, dark in halvings of the light. Held to the range that was fitted.
EvenTerms even_terms(const ViewConditions& conditions);
OddTerms odd_terms(const ViewConditions& conditions);

/// Normalised residuals at 0, 2.5, 5 … 100 %.
inline constexpr std::size_t kQuantiles = 41;
using Quantiles = std::array<double, kQuantiles>;

/// A value with its spread: bias + exp(log_spread) · a residual drawn from the quantiles.
struct SpreadModel {
  EvenTerms bias_even = EvenTerms::Zero();
  OddTerms bias_odd = OddTerms::Zero();
  EvenTerms log_spread = EvenTerms::Zero();
  Quantiles residual{};
  double print_share =
      0.0;                ///< of the residual's variance: the same over a whole run (this print, this room)
  double memory_s = 0.0;  ///< what remains fades with this time constant

  double bias(const ViewConditions& conditions) const;
  double spread(const ViewConditions& conditions) const;
};

/// A positive value whose logarithm is a sum of terms, normally spread.
struct LogModel {
  EvenTerms log_mean = EvenTerms::Zero();
  double log_deviation = 0.0;

  double mean_log(const ViewConditions& conditions) const { return log_mean.dot(even_terms(conditions)); }
};

struct ErrorModel {
  EvenTerms found_log_odds = EvenTerms::Zero();
  EvenTerms flip_log_odds = EvenTerms::Zero();  ///< of an estimate: the back turned to the wrong side
  double found_memory_s = 0.0;
  SpreadModel aspect_rad;   ///< estimated minus true angle to the line of sight
  SpreadModel range_share;  ///< estimated over true distance, minus one
  SpreadModel bearing_rad;  ///< estimated minus true direction
  LogModel certainty;
  LogModel yaw_sigma_rad;  ///< as vision states it
  LogModel time_share;     ///< time vision takes, over that for a person straight ahead at 2 m, tracked
  double missed_log_time_share = 0.0;  ///< when nothing is found
  // ViewConditions beyond what was fitted find nothing.
  double distance_max_m = 0.0;
  double aspect_max_rad = 0.0;

  double found_probability(const ViewConditions& conditions) const;
  double flip_probability(const ViewConditions& conditions) const;
};

/// Throws heel::Error naming file, line and column.
ErrorModel read_error_model(const std::string& path);
/// `note` is a line of comment: what it was fitted to.
void write_error_model(const ErrorModel& model, const std::string& note, const std::string& path);

}  // namespace heel::sim
