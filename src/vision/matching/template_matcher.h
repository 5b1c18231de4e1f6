// The one place where vision pairs the template's features with a frame's:
//   match_everywhere   nothing is known of where the template is: each is compared with the whole frame
//   match_near         each has a predicted place and size: it is compared with the frame's features near it
// Both return pairs (ref: template, cur: frame) that are valid until the next call of either.
#pragma once

#include <span>
#include <vector>

#include "heel/features.h"
#include "heel/matching.h"
#include "vision/matching/feature_grid.h"
#include "vision/matching/guided_matcher.h"

namespace heel {

class TemplateMatcher {
 public:
  /// `reference` must outlive this. Memory is taken once. `ratio`: see MatchSettings.
  TemplateMatcher(const FeatureSet& reference, int max_frame_features, float ratio);

  /// Laplacian sign, ratio test and mutual check over the whole frame (heel/matching.h).
  std::span<const Match> match_everywhere(const FeatureSet& frame);

  /// Laplacian sign, place, scale, distance and ratio test near each prediction (GuidedMatchSettings).
  /// `predicted`: one for each of the template's features, in their order.
  std::span<const Match> match_near(std::span<const PredictedFeature> predicted, const FeatureGrid& frame);

 private:
  const FeatureSet& reference_;
  Matcher whole_frame_matcher_;
  GuidedMatcher guided_matcher_;
  std::vector<Match> matches_;
};

}  // namespace heel
