// The rotation and translation that best carry one set of points to another.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace heel::sim {

/// to ≈ R from + t.
struct RigidFit {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_m{0, 0, 0};
};

/// Least squares over pairs of points (W. Kabsch, "A solution for the best rotation to relate two sets of
/// vectors", 1976). Both sets have the same number of points, at least three that are not on a line.
RigidFit fit_rigid(const std::vector<Eigen::Vector3d>& from_m, const std::vector<Eigen::Vector3d>& to_m);

}  // namespace heel::sim
