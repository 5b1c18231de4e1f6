// Finds small square patches of the reference view in a frame, each by itself, near predicted places. Where
// the cloth is sharp, a patch is placed several times more precisely than a feature; an edge counts along
// its normal. Patches cover the whole print, features only its blobs.
//
// Convention: pixels as they lie in the image (distorted).
// Source: B. Lucas, T. Kanade, "An iterative image registration technique with an application to stereo
// vision", IJCAI 1981; inverse compositional form: S. Baker, I. Matthews, "Lucas-Kanade 20 years on", IJCV
// 56(3), 2004.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "heel/flow.h"
#include "heel/shirt_template.h"
#include "vision/patches/grey_pyramid.h"

namespace heel {

struct PatchSettings {
  // A closer grid finds no better pose; a wider one loses precision (spacing 13: a tenth).
  double spacing_px = 9.0;  ///< of the grid of centres in the reference view
  std::size_t max_patches = 150;
  double half_size_px = 8.0;      ///< in the reference view
  double min_correlation = 0.75;  ///< normalised
  double max_shift_px = 5.0;      ///< between the predicted place and where it is found
  double min_gradient = 6.0;      ///< grey levels a pixel, root mean square over the patch
};

/// Where a patch's centre should be in the frame, and how its surroundings are mapped there.
struct PredictedPatch {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d cur_from_ref = Eigen::Matrix2d::Zero();  ///< d cur_px / d ref_px; singular: not visible

  bool visible() const;
};

struct AlignedPatch {
  std::size_t patch = 0;  ///< index into PatchAligner::centres_px
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  ///< inverse covariance of px, from grey levels
};

class PatchAligner {
 public:
  /// Chooses the patches of the template's region with the largest gradients.
  PatchAligner(const ShirtTemplate& shirt, const PatchSettings& settings);

  std::span<const Eigen::Vector2d> centres_px() const { return centres_px_; }

  /// The patches that are found. `predicted`: one for each centre. Allocates nothing when `out` has capacity
  /// for all of them.
  void align(const FrameView& frame, std::span<const PredictedPatch> predicted,
             std::vector<AlignedPatch>& out) const;

 private:
  std::optional<AlignedPatch> align_one(const FrameView& frame, std::size_t patch,
                                        const PredictedPatch& predicted) const;

  PatchSettings settings_;
  GreyPyramid reference_;
  std::vector<Eigen::Vector2d> centres_px_;
};

}  // namespace heel
