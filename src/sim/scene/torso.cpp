#include "sim/scene/torso.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/scene/shirts.h"

namespace heel::sim {
namespace {

// Half width (y) and half depth (x) by height above the hips: collar, shoulders, shoulder blades, waist,
// hips.
struct Profile {
  double z_m, half_width_m, half_depth_m;
};
constexpr Profile kProfile[] = {{0.620, 0.062, 0.060}, {0.595, 0.098, 0.072}, {0.568, 0.150, 0.088},
                                {0.535, 0.192, 0.104}, {0.480, 0.208, 0.120}, {0.380, 0.207, 0.128},
                                {0.260, 0.190, 0.124}, {0.140, 0.182, 0.119}, {0.020, 0.192, 0.126},
                                {-0.080, 0.202, 0.132}};
constexpr int kProfileCount = static_cast<int>(std::size(kProfile));
constexpr double kTop_m = kProfile[0].z_m;
constexpr double kBottom_m = kProfile[kProfileCount - 1].z_m;
constexpr double kBackCentreZ_m = 0.28;
constexpr int kRings = 26;
constexpr int kSegments = 48;
/// A back is flatter than an ellipse: |x/a|^n + |y/b|^n = 1.
constexpr double kExponent = 2.3;

/// Catmull–Rom interpolation of four values at equal steps, between the second and the third.
double between(double p0, double p1, double p2, double p3, double f) {
  return p1 + 0.5 * f * (p2 - p0 + f * (2 * p0 - 5 * p1 + 4 * p2 - p3 + f * (3 * (p1 - p2) + p3 - p0)));
}

Profile profile_at(double z_m) {
  int i = 0;
  while (i + 2 < kProfileCount && z_m < kProfile[i + 1].z_m) ++i;
  const Profile& a = kProfile[std::max(i - 1, 0)];
  const Profile& b = kProfile[i];
  const Profile& c = kProfile[i + 1];
  const Profile& d = kProfile[std::min(i + 2, kProfileCount - 1)];
  const double f = std::clamp((b.z_m - z_m) / (b.z_m - c.z_m), 0.0, 1.0);
  return {z_m, between(a.half_width_m, b.half_width_m, c.half_width_m, d.half_width_m, f),
          between(a.half_depth_m, b.half_depth_m, c.half_depth_m, d.half_depth_m, f)};
}

/// A point of the surface. `around` goes from the middle of the chest (0) over the person's left to the
/// middle of the back (0.5), and over the right to 1.
Eigen::Vector3d surface_point(double around, double z_m, double depth) {
  const Profile profile = profile_at(z_m);
  const double angle = 2.0 * std::numbers::pi * around;
  const auto power = [](double value) {
    return std::copysign(std::pow(std::abs(value), 2.0 / kExponent), value);
  };
  return {depth * profile.half_depth_m * power(std::cos(angle)),
          profile.half_width_m * power(std::sin(angle)), z_m};
}

/// `around` of the segments' edges at equal steps along the outline, so that the print is not stretched at
/// the sides.
std::vector<double> equal_steps_around(double depth) {
  constexpr int kFine = 4096;
  std::vector<double> length{0.0};
  for (int i = 1; i <= kFine; ++i)
    length.push_back(length.back() +
                     (surface_point(static_cast<double>(i) / kFine, kBackCentreZ_m, depth) -
                      surface_point(static_cast<double>(i - 1) / kFine, kBackCentreZ_m, depth))
                         .norm());
  std::vector<double> around;
  std::size_t at = 0;
  for (int j = 0; j <= kSegments; ++j) {
    const double wanted = length.back() * j / kSegments;
    while (at < length.size() - 1 && length[at] < wanted) ++at;
    around.push_back(static_cast<double>(at) / kFine);
  }
  return around;
}

/// How freely the cloth moves: 0 at the collar, which holds it, 1 from the shoulder blades down.
float cloth_freedom(float z_m) {
  return std::clamp((0.60f - z_m) / 0.15f, 0.f, 1.f);
}

void deform(MeshVertex& vertex, const ClothState& cloth) {
  const float z = vertex.position_m.z();
  const float y = vertex.position_m.y();
  const float free = cloth_freedom(z);
  const auto ripple = static_cast<float>(cloth.ripple_m) * free;
  const auto phase = static_cast<float>(cloth.ripple_rad);
  // The folds are diagonal.
  const float fold =
      std::sin(22.f * z + 9.f * y + phase) + 0.6f * std::sin(14.f * z - 17.f * y - 0.7f * phase);
  const float slope = std::cos(22.f * z + 9.f * y + phase);
  const float from_ribs = (z - 0.36f) / 0.14f;
  const float breath = static_cast<float>(cloth.breath_m) * std::exp(-from_ribs * from_ribs);
  vertex.position_m += vertex.normal * (ripple * fold + breath);
  vertex.normal.z() -= 22.f * ripple * slope;
  vertex.normal.normalize();
  vertex.s_texel -= static_cast<float>(kShirtTexelsPerM * cloth.slide_around_m) * free;
  vertex.t_texel += static_cast<float>(kShirtTexelsPerM * cloth.slide_up_m) * free;
}

/// A point of a mesh: three vertices and their weights.
struct MeshPoint {
  std::array<std::size_t, 3> vertices;
  std::array<double, 3> weights;
};

/// `column` and `row` count segments and rings. A cell consists of two triangles: upper left and lower right.
MeshPoint mesh_point_at(double column, double row) {
  const double c = std::clamp(column, 0.0, kSegments - 1e-9);
  const double r = std::clamp(row, 0.0, kRings - 1 - 1e-9);
  const int j = static_cast<int>(c);
  const int k = static_cast<int>(r);
  const double u = c - j;
  const double v = r - k;
  const auto vertex = [&](int dk, int dj) {
    return static_cast<std::size_t>((k + dk) * (kSegments + 1) + j + dj);
  };
  if (u + v <= 1.0) return {{vertex(0, 0), vertex(0, 1), vertex(1, 0)}, {1.0 - u - v, u, v}};
  return {{vertex(1, 1), vertex(1, 0), vertex(0, 1)}, {u + v - 1.0, 1.0 - u, 1.0 - v}};
}

}  // namespace

Torso::Torso(double depth) : depth_(depth) {
  const std::vector<double> around = equal_steps_around(depth);
  mesh_ = tube(kRings, kSegments, [&](int k, int j) {
    MeshVertex vertex;
    const double z = kTop_m + (kBottom_m - kTop_m) * k / (kRings - 1);
    const double a = around[static_cast<std::size_t>(j)];
    vertex.position_m = surface_point(a, z, depth).cast<float>();
    const Eigen::Vector3d along = surface_point(a + 1e-3, z, depth) - surface_point(a - 1e-3, z, depth);
    const Eigen::Vector3d up = surface_point(a, z + 1e-3, depth) - surface_point(a, z - 1e-3, depth);
    vertex.normal = along.cross(up).normalized().cast<float>();
    vertex.s_texel = static_cast<float>(kShirtWidthTexels) * static_cast<float>(j) / kSegments;
    vertex.t_texel = static_cast<float>((kTop_m - z) * kShirtTexelsPerM);
    return vertex;
  });
  mesh_.texels_per_m = static_cast<float>(kShirtTexelsPerM);
}

Mesh Torso::mesh(const ClothState& cloth) const {
  Mesh out = mesh_;
  for (MeshVertex& vertex : out.vertices) deform(vertex, cloth);
  return out;
}

Eigen::Vector3d Torso::back_centre_m() const {
  return surface_point(0.5, kBackCentreZ_m, depth_);
}

Eigen::Vector3d Torso::shirt_point_m(double s_texel, double t_texel, const ClothState& cloth) const {
  const double columns_per_texel = static_cast<double>(kSegments) / kShirtWidthTexels;
  const double rows_per_texel = (kRings - 1) / ((kTop_m - kBottom_m) * kShirtTexelsPerM);
  double column = s_texel * columns_per_texel;
  double row = t_texel * rows_per_texel;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  // Searches the place where the moved cloth has this texel: the movement is small and smooth, so that a few
  // steps are exact.
  for (int i = 0; i < 8; ++i) {
    const MeshPoint at = mesh_point_at(column, row);
    double s = 0.0;
    double t = 0.0;
    point.setZero();
    for (std::size_t n = 0; n < 3; ++n) {
      MeshVertex vertex = mesh_.vertices[at.vertices[n]];
      deform(vertex, cloth);
      point += at.weights[n] * vertex.position_m.cast<double>();
      s += at.weights[n] * static_cast<double>(vertex.s_texel);
      t += at.weights[n] * static_cast<double>(vertex.t_texel);
    }
    column += (s_texel - s) * columns_per_texel;
    row += (t_texel - t) * rows_per_texel;
  }
  return point;
}

}  // namespace heel::sim
