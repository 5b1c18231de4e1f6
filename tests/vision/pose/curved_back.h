// A curved back in front of a camera: its visible points, and the pose problem they make.
#pragma once

#include <Eigen/LU>
#include <vector>

#include "vision/pose/back_surface.h"
#include "vision/pose/frontal_pose_estimator.h"
#include "vision/pose/scene.h"

namespace heel::test::curved {

inline const Eigen::Matrix3d K = plain_camera().K();
inline const Eigen::Matrix3d K_inverse = K.inverse();
inline const Eigen::Vector2d kCentre_px(320.0, 240.0);  // of the region in which test::inlier_pairs lie

inline constexpr double kDistance_m = 1.5;

/// A back at kDistance_m with the given curvature κ; its shape changes by `shape_sigma_m`, one standard
/// deviation.
inline BackSurface back(double curvature_1_m, double shape_sigma_m = 0.0) {
  BackSurface surface;
  surface.axis_x = (K_inverse * kCentre_px.homogeneous()).x();
  surface.axis_y = (K_inverse * kCentre_px.homogeneous()).y();
  surface.half_size = {100.0 / 600.0, 150.0 / 605.0};
  surface.depth.u2 = curvature_1_m * kDistance_m * surface.half_size.x() * surface.half_size.x();
  surface.shape_sigma = shape_sigma_m / kDistance_m;
  return surface;
}

/// Points of the region of `surface` visible in both views; the five shapes times `departures` are added to
/// it.
inline std::vector<PointPair> pairs_on(const BackSurface& surface, Random& random, const View& view,
                                       int count, double noise_px,
                                       const Vector5d& departures = Vector5d::Zero()) {
  std::vector<PointPair> pairs;
  while (static_cast<int>(pairs.size()) < count) {
    const Eigen::Vector2d ref(random.uniform(220.0, 420.0), random.uniform(90.0, 390.0));
    const Eigen::Vector3d ray = K_inverse * ref.homogeneous();
    const Eigen::Matrix3d KR = K * view.R;
    // The far side of a turned back is not visible.
    if (image_derivative(surface, K_inverse, KR, K * view.t_over_d, ray).determinant() <= 0.0) continue;
    const Eigen::Vector3d point =
        surface.point(ray) + departures.dot(surface.departures(ray)) * Eigen::Vector3d::UnitZ();
    pairs.push_back({ref + random.normal2(noise_px),
                     (KR * point + K * view.t_over_d).hnormalized() + random.normal2(noise_px)});
  }
  return pairs;
}

inline Vector5d drawn_departures(Random& random) {
  Vector5d a;
  for (int i = 0; i < 5; ++i) a(i) = random.normal(1.0);
  return a;
}

inline FrontalProblem problem_of(const std::vector<PointPair>& pairs, const View& view,
                                 const BackSurface& surface) {
  return {pairs, K, K, view.H, kCentre_px, surface};
}

inline PlaneMotion motion_of(const View& view) {
  PlaneMotion motion;
  motion.R_cur_from_ref = view.R;
  motion.t_over_d = view.t_over_d;
  return motion;
}

inline PlaneMotion mirrored(const View& view) {
  FrontalMotion motion;
  motion.R_cur_from_ref = view.R;
  motion.t_over_d = view.t_over_d;
  return mirrored_motion(problem_of({}, view, {}), motion);
}

inline View view_at(double yaw_rad, double depth) {
  View view;
  view.R = rotation(yaw_rad, 0.0, 0.0);
  view.t_over_d = Eigen::Vector3d(0, 0, depth) - view.R.col(2);
  view.H = homography_of(K, K, view.R, view.t_over_d);
  return view;
}

}  // namespace heel::test::curved
