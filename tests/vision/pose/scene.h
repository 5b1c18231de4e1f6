// Synthetic truth for tests of geometry: cameras, motions in front of a plane, point pairs with noise and
// outliers. Each case has its own seed, which a failure reports.
#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "heel/camera_model.h"
#include "heel/homography.h"

namespace heel::test {

inline heel::CameraModel plain_camera() {
  heel::CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx = 600.0;
  camera.fy = 605.0;
  camera.cx = 322.5;
  camera.cy = 238.0;
  return camera;
}

struct Random {
  explicit Random(std::uint64_t seed) : engine(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  double normal(double sigma) { return std::normal_distribution<double>(0.0, sigma)(engine); }
  Eigen::Vector2d normal2(double sigma) { return {normal(sigma), normal(sigma)}; }
  Eigen::Vector3d direction() {
    Eigen::Vector3d v(normal(1.0), normal(1.0), normal(1.0));
    return v.normalized();
  }
  std::mt19937_64 engine;
};

inline Eigen::Matrix3d rotation(double yaw_rad, double pitch_rad, double roll_rad) {
  return (Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

inline Eigen::Matrix3d homography_of(const Eigen::Matrix3d& K_ref, const Eigen::Matrix3d& K_cur,
                                     const Eigen::Matrix3d& R, const Eigen::Vector3d& t_over_d,
                                     const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ()) {
  return K_cur * (R + t_over_d * normal.transpose()) * K_ref.inverse();
}

inline Eigen::Vector2d mapped(const Eigen::Matrix3d& H, const Eigen::Vector2d& point) {
  return (H * point.homogeneous()).hnormalized();
}

/// A view of the shirt as it occurs while following: at some yaw, from about the template's distance.
struct View {
  Eigen::Matrix3d R;
  Eigen::Vector3d t_over_d;
  Eigen::Matrix3d H;
};

inline View random_view(Random& random, const heel::CameraModel& camera, double max_yaw_rad = 1.0) {
  View view;
  view.R = rotation(random.uniform(-max_yaw_rad, max_yaw_rad), random.uniform(-0.15, 0.15),
                    random.uniform(-0.1, 0.1));
  // The template's centre moves to a place in the image at 0.6 … 1.8 times the reference distance.
  const double depth = random.uniform(0.6, 1.8);
  const Eigen::Vector3d centre(random.uniform(-0.25, 0.25) * depth, random.uniform(-0.15, 0.15) * depth,
                               depth);
  view.t_over_d = centre - view.R * Eigen::Vector3d::UnitZ();
  view.H = homography_of(camera.K(), camera.K(), view.R, view.t_over_d);
  return view;
}

/// Points on the back (a region of the reference image), seen through H, with noise in both images.
inline std::vector<heel::PointPair> inlier_pairs(Random& random, const Eigen::Matrix3d& H, int count,
                                                 double noise_px, double noise_ref_px) {
  std::vector<heel::PointPair> pairs;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d ref(random.uniform(220.0, 420.0), random.uniform(90.0, 390.0));
    pairs.push_back({ref + random.normal2(noise_ref_px), mapped(H, ref) + random.normal2(noise_px)});
  }
  return pairs;
}

inline void add_outliers(Random& random, std::vector<heel::PointPair>& pairs, int count) {
  for (int i = 0; i < count; ++i)
    pairs.push_back({{random.uniform(220.0, 420.0), random.uniform(90.0, 390.0)},
                     {random.uniform(0.0, 640.0), random.uniform(0.0, 480.0)}});
}

/// Mean distance of the mapped corners of the region, px.
inline double corner_error_px(const Eigen::Matrix3d& H, const Eigen::Matrix3d& truth) {
  double sum = 0.0;
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(220, 90), Eigen::Vector2d(420, 90),
                                        Eigen::Vector2d(420, 390), Eigen::Vector2d(220, 390)})
    sum += (mapped(H, corner) - mapped(truth, corner)).norm();
  return sum / 4.0;
}

}  // namespace heel::test
