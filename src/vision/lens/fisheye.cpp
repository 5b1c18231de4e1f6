// J. Kannala, S. S. Brandt, "A Generic Camera Model and Calibration Method for Conventional, Wide-Angle, and
// Fish-Eye Lenses", PAMI 2006, with four coefficients, as OpenCV's fisheye and ROS's equidistant:
//   θ_d = θ (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸)
#include <algorithm>
#include <cmath>

#include "vision/lens/lens_models.h"

namespace heel {
namespace {

constexpr double kMaxTheta_rad = 1.5533;  // 89°
constexpr int kMaxSolverSteps = 60;
constexpr double kConverged_rad = 1e-15;

}  // namespace

double fisheye_distance(const CameraModel& camera, double theta_rad) {
  const double t2 = theta_rad * theta_rad;
  return theta_rad * (1.0 + t2 * (camera.k1 + t2 * (camera.k2 + t2 * (camera.k3 + t2 * camera.k4))));
}

double fisheye_slope(const CameraModel& camera, double theta_rad) {
  const double t2 = theta_rad * theta_rad;
  return 1.0 +
         t2 * (3.0 * camera.k1 + t2 * (5.0 * camera.k2 + t2 * (7.0 * camera.k3 + t2 * 9.0 * camera.k4)));
}

Eigen::Vector2d distort_fisheye(const CameraModel& camera, const Eigen::Vector2d& undistorted) {
  const double radius = undistorted.norm();
  if (radius == 0.0) return undistorted;
  return undistorted * (fisheye_distance(camera, std::min(std::atan(radius), kMaxTheta_rad)) / radius);
}

// Newton's method, which a bisection replaces where it leaves the interval that holds the solution.
Eigen::Vector2d undistort_fisheye(const CameraModel& camera, const Eigen::Vector2d& distorted) {
  const double distance = distorted.norm();
  if (distance == 0.0) return distorted;
  double low = 0.0, high = kMaxTheta_rad, theta = std::min(distance, kMaxTheta_rad);
  for (int step = 0; step < kMaxSolverSteps && high - low > kConverged_rad; ++step) {
    const double error = fisheye_distance(camera, theta) - distance;
    (error > 0.0 ? high : low) = theta;
    if (error == 0.0) break;
    const double newton = theta - error / fisheye_slope(camera, theta);
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::abs(next - theta) < kConverged_rad) break;
    theta = next;
  }
  return distorted * (std::tan(theta) / distance);
}

}  // namespace heel
