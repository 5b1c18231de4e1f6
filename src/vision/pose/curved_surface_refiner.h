// From the pose that a homography's pairs give to the pose of the curved back. The pairs that agree on a
// plane lie on one facet of a turned back; those off it tell best how it is turned. So the features are
// matched once more round where the curved surface puts them, those that fit are kept, and the pose is
// refined, a few times over; from both minima, since a facet alone hardly tells them apart. More of the back
// fits the right one.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vision/matching/guided_matcher.h"
#include "vision/pose/alternative_hypotheses.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/motion_refine.h"

namespace heel {

/// The reference view: its features, their undistorted pixels in the same order, and its matrix.
struct ReferenceFeatures {
  const FeatureSet& features;
  std::span<const Eigen::Vector2d> px;
  Eigen::Matrix3d K_inverse;
};

class CurvedSurfaceRefiner {
 public:
  /// What `reference` refers to is to outlive this. Memory is taken once.
  CurvedSurfaceRefiner(const ReferenceFeatures& reference, FrontalPoseEstimator& estimator);

  /// `problem`: as the homography's pairs posed it, `start` its solution; its pairs are replaced by those
  /// that fit the surface. `matcher` looks at the frame's features, `frame_px` are their undistorted pixels.
  /// Where too few fit, `start` is the answer, of no pairs. Its deviations know of the other fits that were
  /// tried.
  FrontalPose follow(const FrontalProblem& problem, const FrontalPose& start, GuidedMatcher& matcher,
                     std::span<const Eigen::Vector2d> frame_px);

  /// How many pairs the last answer rests on.
  std::size_t pairs() const { return best_fitting_.size(); }

 private:
  struct Fit {
    FrontalMotion motion;
    double support = -1.0;  ///< pairs, each less its squared error's share of the limit; −1: too few
  };

  void predict(const FrontalProblem& problem, const FrontalMotion& motion);
  void keep_what_fits(const FrontalProblem& problem, const FrontalMotion& motion, double limit_px,
                      std::span<const Eigen::Vector2d> frame_px);
  FrontalMotion turned(const FrontalProblem& problem, const FrontalMotion& motion, double angle_rad) const;
  void attempt(const FrontalProblem& problem, const FrontalMotion& start, GuidedMatcher& matcher,
               std::span<const Eigen::Vector2d> frame_px);
  void inflate_covariance_by_other_fits(FrontalPose& pose);
  Fit improve(FrontalProblem problem, const FrontalMotion& start, GuidedMatcher& matcher,
              std::span<const Eigen::Vector2d> frame_px);

  ReferenceFeatures reference_;
  FrontalPoseEstimator& estimator_;
  std::vector<PredictedView> predicted_;
  std::vector<Match> matches_;
  std::vector<PointPair> fitting_, best_fitting_;
  Fit best_;
  std::vector<Fit> fits_;  // all that were tried
  std::vector<AlternativeHypothesis> alternatives_;
};

}  // namespace heel
