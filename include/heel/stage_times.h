// Where a frame's time goes: the vision stages say which step they have just finished to whoever measures.
// They read no clock themselves; with nobody measuring a mark is one comparison.
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
  Undistortion,    ///< of the features' places
  Homography,      ///< RANSAC and refinement; again after every guided round
  GuidedMatching,  ///< and the look at the shape before it
  Motion,          ///< decomposition, choice, and the pose with its precision
};
inline constexpr std::size_t kVisionStages = 9;

class StageTimes {
 public:
  virtual ~StageTimes() = default;
  /// Called at the end of a step. What passed since the step before it ended is this one's.
  virtual void ended(VisionStage stage) = 0;
};

inline void mark(StageTimes* times, VisionStage stage) {
  if (times != nullptr) times->ended(stage);
}

}  // namespace heel
