/// \file
/// Settings of the vision stage: the section [vision] of the daemon's configuration file.
///
/// - Units: stand in the names. Ranges and effects: docs/configuration.md.
#pragma once

namespace heel {

/// The defaults are those of the shipped configuration.
struct VisionConfig {
  int octaves = 2;
  int max_features = 1000;
  double match_ratio = 0.8;
  double inlier_px = 3.0;
  int min_inliers = 8;          ///< wrong homographies reach four or five
  double min_certainty = 0.05;  ///< below it the shirt counts as not found
  int ransac_iterations = 5000;
  double distance_min_m = 0.8;       ///< nearest at which the target is looked for
  double distance_max_m = 6.0;       ///< farthest
  bool tracking = true;              ///< search first where the last frame predicts the target
  double tracking_rate_rad_s = 1.5;  ///< largest rate at which the target crosses the view
  double back_curvature_1_m = 1.5;   ///< 1.5: the average back; its depths are in proportion; 0: a plane
  double back_curvature_sigma_1_m = 0.33;  ///< builds differ by this, one standard deviation
  double back_shape_sigma_m = 0.004;  ///< how far folds and breath have moved the back since it was taught
};

}  // namespace heel
