// Beyond the paper: errors over the conditions, sign flips, and whether the stated standard deviations match
// the errors.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "evaluation/reports/still_samples.h"

namespace heel::evaluation {

/// All samples of one condition.
struct ErrorBin {
  std::string name;  ///< "2 ... 3 m"
  double middle = 0.0;
  std::size_t pictures = 0, found = 0, wrong = 0;
  std::size_t signed_pictures = 0, flips = 0;  ///< found with the back turned enough to have a sign; flipped
  double yaw_outward_mean_rad =
      0.0;  ///< error away from facing the camera: negative, seen less turned than it is
  double yaw_mean_rad = 0.0, yaw_deviation_rad = 0.0, yaw_mean_abs_rad = 0.0, yaw_p95_rad = 0.0;
  double x_mean_m = 0.0, x_deviation_m = 0.0, z_mean_m = 0.0, z_deviation_m = 0.0;
  double yaw_nees = 0.0, t_x_nees = 0.0, t_z_nees = 0.0;  ///< means of (error/sigma)²
  double certainty = 0.0;

  double share_found() const {
    return pictures > 0 ? static_cast<double>(found) / static_cast<double>(pictures) : 0.0;
  }
  double share_wrong() const {
    return found > 0 ? static_cast<double>(wrong) / static_cast<double>(found) : 0.0;
  }
};

using Condition = std::function<bool(const StillSample&)>;
ErrorBin error_bin(const std::string& name, double middle, const std::vector<StillSample>& samples,
                   const Condition& belongs);

/// Errors over one condition after the other, the others undisturbed: distance, |yaw|, blur, light,
/// occlusion, shirt. `first` is the condition's name.
struct ErrorCurve {
  std::string condition, unit;
  std::vector<ErrorBin> bins;
};
std::vector<ErrorCurve> error_curves(const std::vector<StillSample>& samples);

/// One row a bin; `middle` is in the curve's unit.
void write_errors(const std::vector<ErrorCurve>& curves, const std::string& path);

/// One row a cell of distance × angle to the line of sight, undisturbed.
void write_error_map(const std::vector<StillSample>& samples, const std::string& path);

/// 95 % of means of `count` squared standard normal values lie between `low` and `high` (normal approximation
/// of the chi-squared distribution, Wilson–Hilferty).
struct NeesBand {
  double low = 0.0, high = 0.0;
};
NeesBand nees_band(std::size_t count);

}  // namespace heel::evaluation
