// The sums over a patch's samples that its alignment needs, computed with vector instructions.
//
// Convention: pixels as they lie in the image. Units: grey levels.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "heel/flow.h"
#include "vision/patches/grey_pyramid.h"

namespace heel {

/// A patch of the frame compared with the model.
struct PatchComparison {
  double variance = 0.0;                               ///< of the frame's samples
  double correlation = 0.0;                            ///< normalised
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  ///< of half the squared difference, by the shift
};

/// A patch as the frame should show it, and its derivatives by place. Its mean is removed, and that of its
/// derivatives.
class PatchModel {
 public:
  /// `warped`: (side + 2) × (side + 2) samples.
  PatchModel(const PatchSamples& warped, int side);

  double variance() const { return squares_ / count_; }
  /// Σ of the products of the derivatives.
  Eigen::Matrix2d hessian() const;
  /// With the frame's samples whose first one lies at `first_px`. Their contrast is scaled to that of the
  /// model. Nothing: a sample would lie outside of the frame.
  std::optional<PatchComparison> compare(const FrameView& frame, const Eigen::Vector2d& first_px) const;

 private:
  int side_;
  std::size_t padded_;  // a whole number of vectors; samples beyond the patch are 0
  double count_;
  PatchSamples value_{}, by_x_{}, by_y_{};
  double squares_, xx_, xy_, yy_, value_x_, value_y_;
};

}  // namespace heel
