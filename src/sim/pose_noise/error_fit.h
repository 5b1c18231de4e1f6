// Fits the error model to pictures of known truth.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/pose_noise/error_model.h"

namespace heel::sim {

/// One picture: its conditions, and what vision made of it. Errors are estimated minus true.
struct FitRow {
  ViewConditions conditions;
  std::uint64_t world = 0;  ///< pictures of one print in one room have the same
  double t_s = 0.0;         ///< in a sequence
  bool found = false;
  bool flipped = false;
  double certainty = 0.0;
  double aspect_error_rad = 0.0, range_error_share = 0.0, bearing_error_rad = 0.0;
  double yaw_sigma_rad = 0.0;
  double vision_ms = 0.0;
};

/// `stills` tell the errors by their conditions, `walk`, frame after frame, how long an error lasts. Throws
/// heel::Error where there are too few.
ErrorModel fit_error_model(const std::vector<FitRow>& stills, const std::vector<FitRow>& walk);

/// The conditions of a truth: what hides the back, and what of it is out of the picture, is one share.
/// `occluded` as evaluation::StillImageView.
ViewConditions conditions_of(double x_m, double z_m, double yaw_rad, double fx_px, double cx_px,
                             double width_px, double occluded);

}  // namespace heel::sim
