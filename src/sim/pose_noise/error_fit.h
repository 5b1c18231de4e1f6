// Fits the pose-noise model to pictures with known truth.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/pose_noise/error_model.h"

namespace heel::sim {

/// One picture: its conditions, and vision's result. Errors are estimated minus true values.
struct FitRow {
  ViewConditions conditions;
  std::uint64_t world = 0;  ///< the same for all pictures of one print in one room
  double t_s = 0.0;         ///< of a frame in a sequence
  bool found = false;
  bool flipped = false;
  double certainty = 0.0;
  double aspect_error_rad = 0.0, range_error_share = 0.0, bearing_error_rad = 0.0;
  double yaw_sigma_rad = 0.0;
  double vision_ms = 0.0;
};

/// Fits errors by conditions to `pictures`, and correlation times to the consecutive frames of `walk`. Throws
/// heel::Error when there are too few pictures.
ErrorModel fit_error_model(const std::vector<FitRow>& pictures, const std::vector<FitRow>& walk);

/// The conditions of a view with known truth. `hidden` becomes the larger of the occluded share and the share
/// out of the picture; `occluded` as in evaluation::StillImageView.
ViewConditions conditions_of(double x_m, double z_m, double yaw_rad, double fx_px, double cx_px,
                             double width_px, double occluded);

}  // namespace heel::sim
