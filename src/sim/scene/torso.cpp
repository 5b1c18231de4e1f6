#include "sim/scene/torso.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
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
constexpr int kRings = 44;
constexpr int kSegments = 96;
/// A body is flatter than an ellipse: |x/a|^n + |y/b|^n = 1.
constexpr double kExponent = 2.3;
/// Distance of the middle of the back from the body's axis.
constexpr double kBackX_m = 0.124;
/// The relief of the back fades out towards the sides, by x relative to the half depth.
constexpr double kReliefNone = 0.2, kReliefWhole = 0.5;
constexpr double kReliefTop = -1.35;  ///< and towards the collar, by v

constexpr double kBoardHalfWidth_m = 0.21;

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

double smooth_step(double share) {
  const double f = std::clamp(share, 0.0, 1.0);
  return f * f * (3.0 - 2.0 * f);
}

/// A point of the body. `around` goes from the middle of the chest (0) over the person's left to the middle
/// of the back (0.5), and over the right to 1.
Eigen::Vector3d body_point(double around, double z_m, double depth, const BackShape& back) {
  const Profile profile = profile_at(z_m);
  const double angle = 2.0 * std::numbers::pi * around;
  const auto power = [](double value) {
    return std::copysign(std::pow(std::abs(value), 2.0 / kExponent), value);
  };
  const double ahead = power(std::cos(angle));
  Eigen::Vector3d point(depth * profile.half_depth_m * ahead, profile.half_width_m * power(std::sin(angle)),
                        z_m);
  const double v = (kBackMiddleZ_m - z_m) / kBackHalfHeight_m;
  const double relief = smooth_step((-ahead - kReliefNone) / (kReliefWhole - kReliefNone)) *
                        smooth_step((v - kReliefTop) / (-1.0 - kReliefTop));
  if (relief > 0.0)
    point.x() += relief * (back.depth_m(-point.y() / kBackHalfWidth_m, v) - depth * kBackX_m - point.x());
  return point;
}

/// `around` of the segments' edges at equal steps along the outline, so that the print is not stretched at
/// the sides.
std::vector<double> equal_steps_around(double depth, const BackShape& back) {
  constexpr int kFine = 4096;
  std::vector<double> length{0.0};
  Eigen::Vector3d before = body_point(0.0, kBackCentreZ_m, depth, back);
  for (int i = 1; i <= kFine; ++i) {
    const Eigen::Vector3d here = body_point(static_cast<double>(i) / kFine, kBackCentreZ_m, depth, back);
    length.push_back(length.back() + (here - before).norm());
    before = here;
  }
  std::vector<double> around;
  std::size_t at = 0;
  for (int j = 0; j <= kSegments; ++j) {
    const double wanted = length.back() * j / kSegments;
    while (at < length.size() - 1 && length[at] < wanted) ++at;
    around.push_back(static_cast<double>(at) / kFine);
  }
  return around;
}

/// Of the mesh's columns and rows.
ClothGrid grid_of_mesh() {
  ClothGrid grid;
  for (int j = 0; j <= kSegments; ++j)
    grid.s_m.push_back(kShirtWidthTexels / kShirtTexelsPerM * (static_cast<double>(j) / kSegments - 0.5));
  for (int k = 0; k < kRings; ++k) grid.z_m.push_back(kTop_m + (kBottom_m - kTop_m) * k / (kRings - 1));
  return grid;
}

/// How freely the cloth moves: 0 at the collar, which holds it, and in the middle of the chest, 1 from the
/// shoulder blades down.
float cloth_freedom(float s_texel, float z_m) {
  const float from_chest_m =
      0.5f * static_cast<float>(kShirtWidthTexels / kShirtTexelsPerM) -
      std::abs(s_texel - 0.5f * kShirtWidthTexels) / static_cast<float>(kShirtTexelsPerM);
  return std::clamp((0.60f - z_m) / 0.15f, 0.f, 1.f) * std::clamp(from_chest_m / 0.15f, 0.f, 1.f);
}

/// The share of the hem's turn: none at the shoulder blades.
float twist_share(float z_m) {
  return std::clamp((0.45f - z_m) / 0.5f, 0.f, 1.f);
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

Torso::Torso(TorsoShape shape, double depth, std::uint64_t seed)
    : shape_(shape),
      depth_(depth),
      back_(depth, derived_seed(seed, 1)),
      around_(equal_steps_around(depth, back_)),
      cloth_(derived_seed(seed, 2), grid_of_mesh()) {
  mesh_ = tube(kRings, kSegments, [&](int k, int j) {
    const double z = kTop_m + (kBottom_m - kTop_m) * k / (kRings - 1);
    return rest_vertex(around_[static_cast<std::size_t>(j)],
                       static_cast<double>(kShirtWidthTexels) * j / kSegments, z);
  });
  mesh_.texels_per_m = static_cast<float>(kShirtTexelsPerM);
}

MeshVertex Torso::rest_vertex(double around, double s_texel, double z_m) const {
  MeshVertex vertex;
  vertex.s_texel = static_cast<float>(s_texel);
  vertex.t_texel = static_cast<float>((kTop_m - z_m) * kShirtTexelsPerM);
  if (shape_ == TorsoShape::Board) {
    // What is beside the board has no area.
    const double right_m = (s_texel - 0.5 * kShirtWidthTexels) / kShirtTexelsPerM;
    vertex.position_m =
        Eigen::Vector3d(-kBackX_m, -std::clamp(right_m, -kBoardHalfWidth_m, kBoardHalfWidth_m), z_m)
            .cast<float>();
    vertex.normal = -Eigen::Vector3f::UnitX();
    return vertex;
  }
  const auto at = [&](double a, double z) { return body_point(a, z, depth_, back_); };
  vertex.position_m = at(around, z_m).cast<float>();
  const Eigen::Vector3d along = at(around + 1e-3, z_m) - at(around - 1e-3, z_m);
  const Eigen::Vector3d up = at(around, z_m + 1e-3) - at(around, z_m - 1e-3);
  vertex.normal = along.cross(up).normalized().cast<float>();
  return vertex;
}

/// A vertex moved by the cloth, by the ribs below it, and by the twist of the body.
MeshVertex Torso::shifted(const MeshVertex& rest, const ClothShift& shift, const ClothState& state) const {
  if (shape_ == TorsoShape::Board) return rest;
  MeshVertex out = rest;
  const float z = rest.position_m.z();
  const float free = cloth_freedom(rest.s_texel, z);
  const float from_ribs = (z - 0.36f) / 0.14f;
  const float breath = static_cast<float>(state.breath_m) * std::exp(-from_ribs * from_ribs);
  const Eigen::Vector3f around = Eigen::Vector3f::UnitZ().cross(rest.normal).normalized();
  const Eigen::Vector3f up = rest.normal.cross(around);
  out.position_m += (free * shift.normal_m + breath) * rest.normal +
                    free * (shift.around_m + static_cast<float>(state.slide_around_m)) * around +
                    free * (shift.up_m + static_cast<float>(state.slide_up_m)) * up;
  out.normal = (rest.normal - free * (shift.slope_around * around + shift.slope_up * up)).normalized();
  if (state.twist_rad != 0.0) {
    const float angle = static_cast<float>(state.twist_rad) * twist_share(z);
    const float c = std::cos(angle), s = std::sin(angle);
    const auto turn = [&](Eigen::Vector3f& v) { v = {c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()}; };
    turn(out.position_m);
    turn(out.normal);
  }
  return out;
}

Mesh Torso::mesh(const ClothState& state) const {
  Mesh out = mesh_;
  const Cloth::Shifts shifts(cloth_, state);
  std::vector<ClothShift> row;
  for (std::size_t k = 0; k < kRings; ++k) {
    shifts.row(k, row);
    for (std::size_t j = 0; j < row.size(); ++j) {
      MeshVertex& vertex = out.vertices[k * row.size() + j];
      vertex = shifted(vertex, row[j], state);
    }
  }
  return out;
}

Eigen::Vector3d Torso::back_centre_m() const {
  if (shape_ == TorsoShape::Board) return {-kBackX_m, 0.0, kBackCentreZ_m};
  return body_point(0.5, kBackCentreZ_m, depth_, back_);
}

Eigen::Vector3d Torso::back_centre_m(const ClothState& state) const {
  const MeshVertex rest = rest_vertex(0.5, 0.5 * kShirtWidthTexels, kBackCentreZ_m);
  const MeshVertex now = shifted(rest, Cloth::Shifts(cloth_, state).at(0.0, kBackCentreZ_m), state);
  return back_centre_m() + (now.position_m - rest.position_m).cast<double>();
}

Eigen::Vector3d Torso::shirt_point_m(double s_texel, double t_texel, const ClothState& state) const {
  const Cloth::Shifts shifts(cloth_, state);
  const ClothGrid& grid = cloth_.grid();
  const MeshPoint at = mesh_point_at(s_texel * kSegments / kShirtWidthTexels,
                                     t_texel * (kRings - 1) / ((kTop_m - kBottom_m) * kShirtTexelsPerM));
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t row = at.vertices[n] / (kSegments + 1), column = at.vertices[n] % (kSegments + 1);
    const ClothShift shift = shifts.at(grid.s_m[column], grid.z_m[row]);
    point += at.weights[n] * shifted(mesh_.vertices[at.vertices[n]], shift, state).position_m.cast<double>();
  }
  return point;
}

std::vector<Eigen::Vector3d> Torso::back_points_m(const ClothState& state) const {
  constexpr std::size_t kRowStep = 4, kColumnStep = 3;
  constexpr double kHalfAround_m =
      0.161;  // a little more than half the width: the cloth goes round the sides
  const Cloth::Shifts shifts(cloth_, state);
  const ClothGrid& grid = cloth_.grid();
  std::vector<Eigen::Vector3d> points;
  std::vector<ClothShift> row;
  for (std::size_t k = 0; k < kRings; k += kRowStep) {
    if (std::abs(grid.z_m[k] - kBackMiddleZ_m) > kBackHalfHeight_m) continue;
    shifts.row(k, row);
    for (std::size_t j = 0; j <= kSegments; j += kColumnStep)
      if (std::abs(grid.s_m[j]) <= kHalfAround_m)
        points.push_back(
            shifted(mesh_.vertices[k * row.size() + j], row[j], state).position_m.cast<double>());
  }
  return points;
}

}  // namespace heel::sim
