// The other minimum of a back's pose. From afar a back that is turned to one side looks nearly like one that
// is turned as far to the other: only its relief tells them apart, and cloth that hangs otherwise than when
// it was taught hides it. A back seen straight from behind has such minima to either side.
//
// Convention: X_cur / d = R_cur_from_ref X_ref / d + t_over_d.
#pragma once

#include "heel/flow.h"
#include "vision/pose/frontal_pose_estimator.h"
#include "vision/pose/surface_pose_refiner.h"

namespace heel {

/// The pose whose patches agree better: `pose`, or the other minimum, which is searched for in `frame`. Its
/// sigmas contain the chance that the one not chosen is true, by how nearly its patches agree. `geometry`:
/// cameras, centre and surface; its pairs are not used.
FrontalPose better_minimum(SurfacePoseRefiner& patch_refiner, const FrameView& frame,
                           const FrontalProblem& geometry, const SurfacePose& pose);

/// `chosen`; its sigmas contain the chance that `rejected` is true.
FrontalPose weighed(const SurfacePose& chosen, const SurfacePose& rejected);

}  // namespace heel
