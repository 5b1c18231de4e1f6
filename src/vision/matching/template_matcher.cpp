#include "vision/matching/template_matcher.h"

namespace heel {

TemplateMatcher::TemplateMatcher(const FeatureSet& reference, int max_frame_features, float ratio)
    : reference_(reference),
      whole_frame_matcher_(static_cast<int>(reference.features.size()), max_frame_features,
                           MatchSettings{.ratio = ratio, .mutual = true}),
      guided_matcher_(max_frame_features, GuidedMatchSettings{}) {
  matches_.reserve(reference.features.size());
}

std::span<const Match> TemplateMatcher::match_everywhere(const FeatureSet& frame) {
  whole_frame_matcher_.match(reference_, frame, matches_);
  return matches_;
}

std::span<const Match> TemplateMatcher::match_near(std::span<const PredictedFeature> predicted,
                                                   const FeatureGrid& frame) {
  guided_matcher_.match(reference_, predicted, frame, matches_);
  return matches_;
}

}  // namespace heel
