// Memory for one frame's way through PoseEstimator, taken once. A step writes its own part and returns a
// value, or a view of that part; the next steps read what they were given, never this.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "heel/homography.h"
#include "heel/matching.h"
#include "heel/stage_times.h"
#include "vision/matching/guided_matcher.h"

namespace heel {

struct PoseWorkspace {
  explicit PoseWorkspace(std::size_t template_features) {
    pairs.reserve(template_features);
    inlier_mask.reserve(template_features);
    inlier_matches.reserve(template_features);
    inliers.reserve(template_features);
    predicted.reserve(template_features);
    scale_disagreement.reserve(template_features);
    inliers_ref_normalised.reserve(template_features);
  }

  // Homography.
  std::vector<PointPair> pairs;
  std::vector<std::uint8_t> inlier_mask;
  std::vector<Match> inlier_matches;
  std::vector<PointPair> inliers;
  std::vector<PredictedFeature> predicted;
  std::vector<double> scale_disagreement;
  // Choice of motion.
  std::vector<Eigen::Vector2d> inliers_ref_normalised;

  StageTimes* times = nullptr;  ///< told when a step ends
};

}  // namespace heel
