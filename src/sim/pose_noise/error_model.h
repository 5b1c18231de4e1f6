// The pose-noise model: a model of vision that replaces rendered pictures. It gives, for the conditions of a
// view, whether the shirt is found, the certainty, the errors of the pose and their stated sigma, and the
// time. Every quantity is a sum of a few terms with fitted weights, so that people can read the file; the
// shape of the noise is stored as quantiles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace heel::sim {

/// The conditions of one picture.
struct ViewConditions {
  double distance_m = 2.0;  ///< horizontal distance from the camera to the middle of the back
  double aspect_rad = 0.0;  ///< angle of the back to the line of sight, signed as PoseEstimate::yaw_rad
  double blur_px = 0.0;     ///< length of the motion blur
  double light = 1.0;       ///< level; the template is made at 1
  /// Share of the back's width that is hidden or out of the picture, from its left edge; negative: from its
  /// right edge.
  double hidden = 0.0;
  bool whole_frame_search = false;  ///< the shirt was not tracked from the frame before (term first_look)
  bool other_print = false;         ///< a shirt other than bold
};

/// Terms that do not depend on the side.
inline constexpr std::array kEvenTerms{
    "one",           "distance", "distance2", "angle2", "angle4",  "distance_angle2", "blur",
    "blur_distance", "dark",     "dark2",     "hidden", "hidden2", "first_look",      "other_print"};
/// Terms that change sign with the side.
inline constexpr std::array kOddTerms{"angle",           "angle3",      "angle5",      "distance_angle",
                                      "distance_angle3", "hidden_side", "hidden2_side"};

using EvenTerms = Eigen::Matrix<double, kEvenTerms.size(), 1>;
using OddTerms = Eigen::Matrix<double, kOddTerms.size(), 1>;

/// Distances in metres, angles in radians, dark in halvings of the light, all limited to the range of the
/// fit.
EvenTerms even_terms(const ViewConditions& conditions);
OddTerms odd_terms(const ViewConditions& conditions);

/// Normalised residuals at 0, 2.5, 5 … 100 %.
inline constexpr std::size_t kQuantiles = 41;
using Quantiles = std::array<double, kQuantiles>;

/// An error: bias + exp(log_spread) · a residual with the distribution of the quantiles.
struct SpreadModel {
  EvenTerms bias_even = EvenTerms::Zero();
  OddTerms bias_odd = OddTerms::Zero();
  EvenTerms log_spread = EvenTerms::Zero();
  Quantiles residual{};
  double print_share =
      0.0;  ///< share of the residual's variance that is constant in a run (one print, one room)
  double memory_s = 0.0;  ///< correlation time of the rest

  double bias(const ViewConditions& conditions) const;
  double spread(const ViewConditions& conditions) const;
};

/// A positive value whose logarithm is a sum of terms plus normally distributed noise.
struct LogModel {
  EvenTerms log_mean = EvenTerms::Zero();
  double log_deviation = 0.0;

  double mean_log(const ViewConditions& conditions) const { return log_mean.dot(even_terms(conditions)); }
};

struct ErrorModel {
  EvenTerms found_log_odds = EvenTerms::Zero();
  EvenTerms flip_log_odds = EvenTerms::Zero();  ///< the estimate has the back turned to the wrong side
  double found_memory_s = 0.0;
  SpreadModel aspect_rad;   ///< estimated minus true angle to the line of sight
  SpreadModel range_share;  ///< estimated over true distance, minus one
  SpreadModel bearing_rad;  ///< estimated minus true direction
  LogModel certainty;
  LogModel yaw_sigma_rad;  ///< as stated by vision
  LogModel
      time_share;  ///< time of the vision stage, relative to that for a person straight ahead at 2 m, tracked
  double missed_log_time_share = 0.0;  ///< when the shirt is not found
  // Beyond these limits of the fit the shirt is never found.
  double distance_max_m = 0.0;
  double aspect_max_rad = 0.0;

  double found_probability(const ViewConditions& conditions) const;
  double flip_probability(const ViewConditions& conditions) const;
};

/// Throws heel::Error naming file, line and column.
ErrorModel read_error_model(const std::string& path);
/// `note` is a line of comment that says what the model was fitted to.
void write_error_model(const ErrorModel& model, const std::string& note, const std::string& path);

}  // namespace heel::sim
