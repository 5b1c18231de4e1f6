// The minimal solver: the homography through exactly four point pairs, for the inner loop of RANSAC.
//
// Convention: x_cur ~ H_cur_from_ref x_ref. Units: pixels.
// Source: R. Hartley and A. Zisserman, "Multiple View Geometry", 2nd ed., 2.3; P. Heckbert, "Fundamentals of
// texture mapping and image warping", 1989.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace heel {

/// The fewest pairs that determine a homography.
inline constexpr std::size_t kHomographyPairs = 4;

/// False if the sample cannot be four points of one visible plane: three of them lie (nearly) on a line in
/// one view, or a triangle changes its orientation between the views. (An opaque plane is never mirrored, and
/// points in front of both cameras keep the orientation of every triangle.) Most wrong samples are rejected
/// here, before anything is solved. On success H has w > 0 at the four points, and det H > 0.
bool homography_4pt(const std::array<Eigen::Vector2d, 4>& ref_px,
                    const std::array<Eigen::Vector2d, 4>& cur_px, Eigen::Matrix3d& H_cur_from_ref);

}  // namespace heel
