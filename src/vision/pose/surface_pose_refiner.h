// The last step: the pose of the back from patches of its whole print, and from the features that fit.
//
// Convention: X_cur / d = R_cur_from_ref X_ref / d + t_over_d.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "heel/camera_model.h"
#include "heel/flow.h"
#include "heel/homography.h"
#include "heel/shirt_template.h"
#include "vision/patches/patch_aligner.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/frontal_pose_estimator.h"
#include "vision/pose/surface_pose_solver.h"

namespace heel {

/// A pose, and how well the patches agree with it.
struct SurfacePose {
  FrontalMotion motion;
  Matrix6d covariance = Matrix6d::Zero();  ///< as FrontalPose::covariance
  std::size_t patches = 0;                 ///< found where the pose puts them
  double agreement = 0.0;                  ///< their share of the patches in view
  /// Poses of one frame are compared by it: for each patch found, 1 less its share of the largest cost.
  double score = 0.0;
  double residual_px = 0.0;  ///< median distance of the aligned patches from where the pose puts them
};

/// `motion` turned about the middle of the surface, as the camera sees it; positive: to the image's right.
FrontalMotion turned(const FrontalMotion& motion, double turn_rad, const BackSurface& surface);

/// The same as a pose without alternatives.
FrontalPose frontal_pose(const SurfacePose& pose);

class SurfacePoseRefiner {
 public:
  /// Memory is taken once.
  SurfacePoseRefiner(const ShirtTemplate& shirt, const CameraModel& current_camera);

  /// From `start`: `rounds` times the patches are aligned near where the pose puts them, and the pose is
  /// solved for them and `pairs`, features that fit (undistorted). Nothing: too few patches are found.
  std::optional<SurfacePose> refine(const FrameView& frame, const BackSurface& surface,
                                    std::span<const PointPair> pairs, const FrontalMotion& start, int rounds);

  /// The pose, or a better one that is found from `pose` turned to either side: where few patches agree, it
  /// may be another minimum. Features are left out: those that fit the pose hold it where it is.
  SurfacePose refine_turned(const FrameView& frame, const BackSurface& surface, const SurfacePose& pose,
                            std::span<const double> turns_rad, int rounds);

 private:
  static constexpr std::size_t kNeighbours = 8;

  /// Rays of the reference view: of a patch's centre, and of a pixel to the right of it and below.
  using PatchRays = std::array<Eigen::Vector3d, 3>;

  void predict(const BackSurface& surface, const FrontalMotion& motion);
  void drop_unlike_neighbours();
  bool moves_like_neighbours(const AlignedPatch& patch) const;
  void observe(std::span<const PointPair> pairs);
  double median_residual_px();

  CameraModel camera_;
  Eigen::Matrix3d K_cur_, K_ref_inverse_;
  double ref_px_per_m_;
  PatchAligner aligner_;
  std::vector<PatchRays> rays_;
  std::vector<std::array<std::size_t, kNeighbours>> neighbours_;
  SurfacePoseSolver solver_;
  // Work space: written and read within one call.
  std::vector<PredictedPatch> predicted_;
  std::vector<AlignedPatch> aligned_, kept_;
  std::vector<std::ptrdiff_t> aligned_index_;  // of each patch; −1: not found
  std::vector<SurfaceObservation> observations_;
  std::vector<double> residuals_px_;
};

}  // namespace heel
