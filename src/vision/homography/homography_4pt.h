// The minimal solver: the homography through exactly four point pairs, for RANSAC's inner loop.
// Convention: x_cur ~ H_cur_from_ref x_ref.
#pragma once

#include <Eigen/Core>
#include <array>

namespace heel {

/// False when the sample cannot be four points of one visible plane: three of them (nearly) on a line in
/// either view, or a triangle whose orientation changes between the views (an opaque plane is never seen
/// mirrored, and points in front of both cameras keep the order round any three of them). Random wrong
/// samples fail here most of the time, before anything is solved.
/// On success H has w > 0 at the four points, and det H > 0.
bool homography_4pt(const std::array<Eigen::Vector2d, 4>& ref_px,
                    const std::array<Eigen::Vector2d, 4>& cur_px, Eigen::Matrix3d& H_cur_from_ref);

}  // namespace heel
