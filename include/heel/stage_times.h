/// \file
/// Where a frame's time goes: vision reports the end of each step to an object that measures.
///
/// - Convention: vision reads no clock; the object that is called does. Without one a step costs one
///   comparison.
/// - Errors: none.
#pragma once

#include <cstddef>
#include <cstdint>

namespace heel {

/// The steps of vision, in the order a frame goes through them.
enum class VisionStage : std::uint8_t {
  Integral,
  Hessian,         ///< fast-Hessian responses and their maxima
  Selection,       ///< the strongest, spread over the image
  Description,     ///< orientation, where asked for, and descriptors
  Matching,        ///< nearest neighbours in the template
  Undistortion,    ///< of the features' places, and their order by place
  Homography,      ///< RANSAC and refinement; again after every guided round
  GuidedMatching,  ///< and the check of the shape before it
  Motion,          ///< decomposition, choice, and the pose with its sigma; where there is none, the checks
};
inline constexpr std::size_t kVisionStages = 9;

/// Implement this to measure, and pass it to the measure() of an extractor, estimator or tracker.
class StageTimes {
 public:
  virtual ~StageTimes() = default;
  /// Called at the end of a step. The time since the end of the step before it is this step's.
  virtual void ended(VisionStage stage) = 0;
};

/// Reports the end of a step if anybody measures.
inline void mark(StageTimes* times, VisionStage stage) {
  if (times != nullptr) times->ended(stage);
}

}  // namespace heel
