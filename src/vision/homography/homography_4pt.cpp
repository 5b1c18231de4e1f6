// By the projective basis: with M = [a1 a2 a3] and a4 = M λ, N = [b1 b2 b3] and b4 = N μ (homogeneous
// points),
//   H = N diag(μi / λi) M⁻¹.
// λi det M and μi det N are twice the signed areas of the triangles of a4 (b4) with two of the others. The
// checks of degeneracy and orientation use these areas and so cost nothing more.
#include "vision/homography/homography_4pt.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace heel {
namespace {

// Twice the smallest triangle's area, relative to the square of the sample's extent.
constexpr double kCollinear = 1e-4;

struct Areas {
  double whole;    ///< det M: triangle 1 2 3
  double part[3];  ///< point i of the triangle replaced by point 4
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Signed areas with point 4 as the origin; false when three of the four points are nearly collinear.
bool signed_areas(const std::array<Eigen::Vector2d, 4>& points, Areas& areas) {
  const Eigen::Vector2d a = points[0] - points[3], b = points[1] - points[3], c = points[2] - points[3];
  areas.part[0] = cross(b, c);  // |4 2 3|
  areas.part[1] = cross(c, a);  // |1 4 3|
  areas.part[2] = cross(a, b);  // |1 2 4|
  areas.whole = areas.part[0] + areas.part[1] + areas.part[2];
  const double smallest = std::min(std::min(std::abs(areas.part[0]), std::abs(areas.part[1])),
                                   std::min(std::abs(areas.part[2]), std::abs(areas.whole)));
  const double extent2 = std::max(a.squaredNorm(), std::max(b.squaredNorm(), c.squaredNorm()));
  return smallest > kCollinear * extent2;
}

}  // namespace

bool homography_4pt(const std::array<Eigen::Vector2d, 4>& ref_px,
                    const std::array<Eigen::Vector2d, 4>& cur_px, Eigen::Matrix3d& H_cur_from_ref) {
  Areas ref{}, cur{};
  if (!signed_areas(ref_px, ref) || !signed_areas(cur_px, cur)) return false;
  if (ref.whole * cur.whole <= 0.0) return false;
  for (int i = 0; i < 3; ++i)
    if (ref.part[i] * cur.part[i] <= 0.0) return false;

  // Rows of M⁻¹ det M: row i is the line through the two other points.
  Eigen::Matrix3d lines;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d& p = ref_px[static_cast<std::size_t>((i + 1) % 3)];
    const Eigen::Vector2d& q = ref_px[static_cast<std::size_t>((i + 2) % 3)];
    lines.row(i) << p.y() - q.y(), q.x() - p.x(), p.x() * q.y() - p.y() * q.x();
  }
  Eigen::Matrix3d weighted;  // N diag(μi / λi), up to the positive factor det M / det N
  for (int i = 0; i < 3; ++i)
    weighted.col(i) = (cur.part[i] / ref.part[i]) * cur_px[static_cast<std::size_t>(i)].homogeneous();
  H_cur_from_ref = weighted * lines / ref.whole;
  return true;
}

}  // namespace heel
