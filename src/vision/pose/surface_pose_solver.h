// The pose of a known surface from places of its points in the frame: robust least squares, with two
// departures of the cloth that look like a turn as nuisance parameters: the keystone, one side hanging longer
// than the other, and the vertical stretch.
//
// Convention: X_cur / d = R_cur_from_ref X_ref / d + t_over_d. Units: undistorted pixels, radians, t/d.
// Source: robust cost: S. Geman, D. McClure, "Statistical methods for tomographic image reconstruction",
// Bull. ISI 52, 1987. Covariance: P. Huber, "The behavior of maximum likelihood estimates under nonstandard
// conditions", 1967.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "vision/pose/back_surface.h"
#include "vision/pose/frontal_pose_estimator.h"

namespace heel {

struct SurfaceObservation {
  Eigen::Vector3d ray;         ///< (x, y, 1) of the reference view
  Eigen::Vector2d cur_px;      ///< undistorted
  Eigen::Matrix2d covariance;  ///< px², of the measurement; that of the cloth is added
};

/// What is known of the pose: deviations from the start, one standard deviation.
struct MotionPrior {
  Eigen::Vector3d turn_rad;  ///< about the camera's axes
  Eigen::Vector3d t_over_d;
};

class SurfacePoseSolver {
 public:
  /// Memory is taken once for `max_observations`.
  SurfacePoseSolver(const Eigen::Matrix3d& K_cur, std::size_t max_observations);

  std::size_t max_observations() const { return max_observations_; }

  /// At most `max_steps` Gauss–Newton steps from `start`. Further observations than the maximum are ignored.
  FrontalMotion solve(const BackSurface& surface, std::span<const SurfaceObservation> observations,
                      const FrontalMotion& start, int max_steps,
                      const std::optional<MotionPrior>& prior = std::nullopt);

  // Of the last solution:

  /// Of (ω, δt) as in FrontalPose: from the noise, and from smooth departures of cloth and body.
  Matrix6d covariance() const;
  /// 1: the observation fits; 0: it is far off.
  double weight(std::size_t observation) const { return linearised_[observation].weight; }
  /// The distance between where an observation is and where the pose puts it.
  double residual_px(std::size_t observation) const { return linearised_[observation].residual_px.norm(); }
  /// The robust cost of an observation, in variances; less than kMaxCost.
  double cost(std::size_t observation) const;

  static constexpr double kMaxCost = 12.5;  // 2 · 2.5²

 private:
  static constexpr int kUnknowns = 8;  // ω, δt, keystone, stretch
  using Vector8d = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix8d = Eigen::Matrix<double, kUnknowns, kUnknowns>;

  struct LinearisedObservation {
    Eigen::Vector3d ray;
    Eigen::Matrix<double, 2, kUnknowns> J;  ///< d predicted px / d unknowns
    Matrix23d by_point;                     ///< d predicted px / d X_ref
    Eigen::Vector2d residual_px;            ///< observed less predicted
    Eigen::Matrix2d information;
    double squared = 0.0;  ///< normalised residual, squared
    double weight = 1.0;
  };

  void linearise(const BackSurface& surface, std::span<const SurfaceObservation> observations,
                 const FrontalMotion& motion);
  Matrix8d nuisance_precision() const;

  Eigen::Matrix3d K_cur_;
  std::size_t max_observations_;
  // Of the last solution.
  BackSurface surface_;
  double keystone_ = 0.0, stretch_ = 0.0;  // at the corner and the lower edge of the region, in units of d
  std::vector<LinearisedObservation> linearised_;
};

}  // namespace heel
