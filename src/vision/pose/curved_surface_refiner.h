// From the pose that a homography's pairs give to the pose of the curved back. The pairs that agree on one
// plane lie on one facet of a turned back; those off that plane show best how far the back is turned. So the
// features are matched again near where the curved surface puts them, those that fit are kept and the pose is
// refined, several times. Starts are both minima of the plane's pose, which one facet hardly distinguishes,
// and, where few pairs fit, other yaws. The pose that fits most of the back is the answer.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "vision/matching/feature_grid.h"
#include "vision/matching/template_matcher.h"
#include "vision/pose/alternative_hypotheses.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/frontal_pose_estimator.h"
#include "vision/pose/surface_matcher.h"

namespace heel {

struct CurvedSurfacePose {
  FrontalPose pose;
  /// That the pose rests on, valid until the next call; none: too few fitted, the pose is the start.
  std::span<const PointPair> pairs;
};

class CurvedSurfaceRefiner {
 public:
  /// `reference_px`: the template's features, undistorted, in the matcher's order; they, `estimator` and
  /// `surface_matcher` must outlive this. Memory is taken once.
  CurvedSurfaceRefiner(std::span<const Eigen::Vector2d> reference_px, const Eigen::Matrix3d& K_ref_inverse,
                       FrontalPoseEstimator& estimator, SurfaceMatcher& surface_matcher);

  /// `problem`: the homography's pairs on the curved surface, `start` its solution. The deviations of the
  /// answer include the other fits that were tried.
  CurvedSurfacePose refine(const FrontalProblem& problem, const FrontalPose& start, TemplateMatcher& matcher,
                           const FeatureGrid& frame);

 private:
  struct Fit {
    FrontalMotion motion;
    double support = -1.0;  ///< pairs, each less its squared error's share of the limit; −1: too few pairs
    std::span<const PointPair> pairs;  ///< a view of fitting_: valid until the next fit
  };

  Fit fit_surface(FrontalProblem problem, const FrontalMotion& start, TemplateMatcher& matcher,
                  const FeatureGrid& frame);
  FrontalMotion turned(const FrontalProblem& problem, const FrontalMotion& motion, double angle_rad) const;
  std::span<const AlternativeHypothesis> alternatives_to(const FrontalMotion& chosen, std::span<Fit> fits,
                                                         double best_support);

  std::span<const Eigen::Vector2d> reference_px_;
  Eigen::Matrix3d K_ref_inverse_;
  FrontalPoseEstimator& estimator_;
  SurfaceMatcher& surface_matcher_;
  // Work space: written and read within one call.
  std::vector<PointPair> fitting_, best_fitting_;
  std::vector<Fit> fits_;
  std::vector<AlternativeHypothesis> alternatives_;
};

}  // namespace heel
