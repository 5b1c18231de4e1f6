#include "vision/pose/average_back.h"

#include <Eigen/Geometry>

namespace heel {
namespace {

// Depths in metres, measured on the backs of three bodies of different build that nobody of this project
// made. Over the place in the region they agree better between builds than over metres. With the
// coefficients of two bodies the third is read as precisely as with those of all three.
constexpr BackDepth kAverageBack_m{
    .u2 = -0.0133, .u4 = 0.0492, .v = -0.0102, .v2 = -0.0111, .v3 = -0.0061, .u2v = 0.0131};
constexpr double kAverageCurvature_1_m = 1.5;  // VisionConfig::back_curvature_1_m that means this shape

BackDepth scaled(const BackDepth& depth, double factor) {
  return {.u2 = factor * depth.u2,
          .u4 = factor * depth.u4,
          .v = factor * depth.v,
          .v2 = factor * depth.v2,
          .v3 = factor * depth.v3,
          .u2v = factor * depth.u2v};
}

}  // namespace

BackSurface flat_surface(const ReferenceView& reference, const VisionConfig& config) {
  const Eigen::Vector3d top_left = reference.K_inverse * reference.outline_px[0].homogeneous();
  const Eigen::Vector3d bottom_right = reference.K_inverse * reference.outline_px[2].homogeneous();
  BackSurface surface;
  surface.axis_x = 0.5 * (top_left.x() + bottom_right.x());
  surface.axis_y = 0.5 * (top_left.y() + bottom_right.y());
  surface.half_size = 0.5 * (bottom_right - top_left).head<2>();
  if (reference.distance_m > 0.0) surface.shape_sigma = config.back_shape_sigma_m / reference.distance_m;
  return surface;
}

BackSurface average_back(const ReferenceView& reference, const VisionConfig& config) {
  BackSurface surface = flat_surface(reference, config);
  if (!(reference.distance_m > 0.0)) return surface;
  surface.depth =
      scaled(kAverageBack_m, config.back_curvature_1_m / kAverageCurvature_1_m / reference.distance_m);
  surface.bend_sigma = config.back_curvature_sigma_1_m * reference.distance_m;
  return surface;
}

}  // namespace heel
