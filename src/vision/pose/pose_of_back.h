// The pose of the person's back from that of a template which shows them from another side.
//
// Model: seen from above a person is an ellipse, 0.36 m wide and 0.24 m deep. A template taught with the
// person turned by ψ (ShirtTemplate::yaw_rad) shows the part of it that faces the camera square on. The
// ellipse's axis lies behind that part by its support function h(ψ) = √((0.12 m cos ψ)² + (0.18 m sin ψ)²),
// the back 0.12 m behind the axis against the walking direction. Bodies differ from this by about 0.03 m, and
// ψ is known to about 5°: the deviations include both.
//
// Convention: those of heel::PoseEstimate, with the first template as the reference view. Units: metres.
#pragma once

#include <Eigen/Core>

#include "heel/flow.h"
#include "heel/shirt_template.h"

namespace heel {

class PoseOfBack {
 public:
  /// From poses by `shirt` to those that `first`, taken from behind, would give.
  PoseOfBack(const ShirtTemplate& shirt, const ShirtTemplate& first);

  /// H_cur_from_ref stays that of the template. Unchanged if `shirt` and `first` are taken from behind, at
  /// the same place, or the pose is not found.
  PoseEstimate in_terms_of_back(const PoseEstimate& pose) const;

 private:
  double distance_m_, first_distance_m_;
  Eigen::Matrix3d R_ref_from_back_;       // turned as the person was
  Eigen::Vector3d back_from_seen_ref_m_;  // from the middle of what is seen to that of the back
  Eigen::Vector3d first_centre_m_;        // of the back, in the first reference view
  bool same_;                             // reference view and side as of the first: nothing changes
  double yaw_sigma_rad_ = 0.0, body_sigma_m_ = 0.0;
};

}  // namespace heel
