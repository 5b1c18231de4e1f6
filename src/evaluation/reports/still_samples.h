// Rows of `heel experiment`, and what they come to at each commanded step.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace heel::evaluation {

/// Whether an estimate counts as wrong: 15° or a tenth of the distance (at least 0.15 m) off.
bool is_wrong(double yaw_error_rad, double off_m, double distance_m);

/// One picture as the report needs it; radians and metres.
struct StillSample {
  std::string name, shirt;
  std::uint64_t seed = 0;
  double light = 1.0, x_m = 0.0, z_m = 0.0, yaw_rad = 0.0, blur_px = 0.0, occluded = 0.0;  // commanded
  double true_x_m = 0.0, true_z_m = 0.0, true_yaw_rad = 0.0, true_t_x_m = 0.0, true_t_z_m = 0.0;
  bool whole_frame_search = false;  ///< looked for in the whole frame, not tracked from the frame before
  bool found = false;
  double certainty = 0.0;  ///< 0 where it was not found
  double yaw_est_rad = 0.0, yaw_sigma_rad = 0.0, x_est_m = 0.0, z_est_m = 0.0;
  double t_x_m = 0.0, t_x_sigma_m = 0.0, t_z_m = 0.0, t_z_sigma_m = 0.0;
  double vision_ms = 0.0;

  double yaw_error_rad() const;
  /// The angle between the back's normal and the line of sight: the plane's sign ambiguity mirrors it.
  double aspect_rad() const;
  /// The estimate has the back turned to the other side of the line of sight than it is.
  bool flipped() const;
  bool wrong() const;  ///< found, and is_wrong()
  /// Nothing but pose and noise: no blur beyond the sensor's own, full light, nothing in between.
  bool undisturbed() const { return blur_px == 0.0 && light == 1.0 && occluded == 0.0; }
};

inline constexpr double kLeastFlipAspect_rad = 0.1745329;  ///< 10°: nearer to frontal a sign means nothing

/// Throws heel::Error naming file, line and column.
std::vector<StillSample> read_stills(const std::string& path);

/// What all pictures at one commanded value come to.
struct Step {
  double at = 0.0;
  std::size_t pictures = 0, found = 0;
  double truth = 0.0;  ///< mean of the true value
  double mean = 0.0, deviation = 0.0, mean_abs_error = 0.0;
  double certainty_mean = 0.0, certainty_low = 0.0,
         certainty_high = 0.0;  ///< low, high: 5th, 95th percentile

  double share_found() const { return static_cast<double>(found) / static_cast<double>(pictures); }
};

using Member = double StillSample::*;
/// Steps in ascending order of `at`. `estimate` and `truth` are taken times `scale`, `at` too.
std::vector<Step> steps_of(const std::vector<StillSample>& samples, Member at, Member estimate, Member truth,
                           double scale = 1.0);

/// "at,pictures,found,truth,mean,deviation,…" with `unit` in the names.
void write_steps(const std::vector<Step>& steps, const std::string& unit, const std::string& path);

}  // namespace heel::evaluation
