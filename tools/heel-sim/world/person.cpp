#include "heel-sim/world/person.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "heel-sim/world/body_parts.h"
#include "heel-sim/world/random.h"

namespace heel::sim {
namespace {

constexpr double kHipHeightM = 0.92;
constexpr double kShoulderZM = 0.50;  ///< above the hips
constexpr double kArmPivotYM = 0.235;
constexpr double kBackCentreZM = 0.28;

// The torso: half width (y) and half depth (x) by height over the hips, smoothly interpolated.
struct Profile {
  double z_m, half_width_m, half_depth_m;
};
constexpr Profile kTorsoProfile[] = {{0.62, 0.065, 0.060}, {0.58, 0.110, 0.080}, {0.54, 0.175, 0.105},
                                     {0.48, 0.205, 0.120}, {0.38, 0.210, 0.128}, {0.26, 0.203, 0.126},
                                     {0.14, 0.195, 0.122}, {0.00, 0.200, 0.128}, {-0.06, 0.203, 0.130}};
constexpr double kTorsoTopM = 0.62;
constexpr double kTorsoBottomM = -0.06;
constexpr int kTorsoRings = 24;
constexpr int kTorsoSegments = 48;
/// A back is flatter than an ellipse: |x/a|^n + |y/b|^n = 1.
constexpr double kTorsoExponent = 2.3;

Profile profile_at(double z_m) {
  constexpr int kCount = static_cast<int>(std::size(kTorsoProfile));
  int i = 0;
  while (i + 2 < kCount && z_m < kTorsoProfile[i + 1].z_m) ++i;
  const Profile& a = kTorsoProfile[i];
  const Profile& b = kTorsoProfile[i + 1];
  const double f = std::clamp((a.z_m - z_m) / (a.z_m - b.z_m), 0.0, 1.0);
  const double smooth = f * f * (3.0 - 2.0 * f);
  return {z_m, a.half_width_m + smooth * (b.half_width_m - a.half_width_m),
          a.half_depth_m + smooth * (b.half_depth_m - a.half_depth_m)};
}

/// Point of the torso's surface; `around` 0…1 from the middle of the chest over the person's left,
/// the middle of the back (0.5), and the right.
Eigen::Vector3d torso_point(double around, double z_m) {
  const Profile profile = profile_at(z_m);
  const double angle = 2.0 * std::numbers::pi * around;
  const auto power = [](double value) {
    return std::copysign(std::pow(std::abs(value), 2.0 / kTorsoExponent), value);
  };
  return {profile.half_depth_m * power(std::cos(angle)), profile.half_width_m * power(std::sin(angle)), z_m};
}

double ring_z_m(double ring) {
  return kTorsoTopM + (kTorsoBottomM - kTorsoTopM) * ring / (kTorsoRings - 1);
}

/// Segment edges at equal steps along the outline, so that the print is not stretched at the sides.
std::vector<double> equal_steps_around() {
  constexpr int kFine = 4096;
  std::vector<double> length{0.0};
  for (int i = 1; i <= kFine; ++i)
    length.push_back(length.back() + (torso_point(static_cast<double>(i) / kFine, kBackCentreZM) -
                                      torso_point(static_cast<double>(i - 1) / kFine, kBackCentreZM))
                                         .norm());
  std::vector<double> around;
  std::size_t at = 0;
  for (int j = 0; j <= kTorsoSegments; ++j) {
    const double wanted = length.back() * j / kTorsoSegments;
    while (at < length.size() - 1 && length[at] < wanted) ++at;
    around.push_back(static_cast<double>(at) / kFine);
  }
  return around;
}

Mesh torso() {
  const std::vector<double> around = equal_steps_around();
  Mesh mesh = tube(kTorsoRings, kTorsoSegments, [&](int k, int j) {
    MeshVertex vertex;
    const double z = ring_z_m(k);
    const double a = around[static_cast<std::size_t>(j)];
    vertex.position_m = torso_point(a, z).cast<float>();
    const Eigen::Vector3d along = torso_point(a + 1e-3, z) - torso_point(a - 1e-3, z);
    const Eigen::Vector3d up = torso_point(a, z + 1e-3) - torso_point(a, z - 1e-3);
    vertex.normal = along.cross(up).normalized().cast<float>();
    vertex.s_texel = static_cast<float>(kShirtWidthTexels) * static_cast<float>(j) / kTorsoSegments;
    vertex.t_texel = static_cast<float>((kTorsoTopM - z) * kShirtTexelsPerM);
    return vertex;
  });
  mesh.texels_per_m = static_cast<float>(kShirtTexelsPerM);
  return mesh;
}

}  // namespace

Person::Person(const PersonSettings& settings, std::uint64_t seed) : settings_(settings) {
  textures_.reserve(4);
  textures_.emplace_back(draw_shirt(settings.shirt, derived_seed(seed, 0x51)));
  textures_.push_back(head_surface(derived_seed(seed, 0x52)));
  textures_.push_back(arm_surface(derived_seed(seed, 0x53)));
  textures_.push_back(trousers_cloth(derived_seed(seed, 0x54)));
  meshes_[kTorso] = torso();
  meshes_[kHead] = head_mesh();
  meshes_[kLeftArm] = meshes_[kRightArm] = arm_mesh();
  meshes_[kLeftLeg] = meshes_[kRightLeg] = leg_mesh();
  meshes_[kTorso].texture = &textures_[0];
  for (const int part : {kHead, kLeftArm, kRightArm, kLeftLeg, kRightLeg}) {
    Mesh& mesh = meshes_[static_cast<std::size_t>(part)];
    mesh.texture = &textures_[part == kHead ? 1 : (part == kLeftArm || part == kRightArm) ? 2 : 3];
    mesh.texels_per_m = 300.f;
  }
}

PersonPose Person::pose(const WalkState& walk, double clock_s) const {
  // The gait fades in with speed, so that a standing person stands.
  const double vigour = std::clamp(walk.speed_m_s / 0.35, 0.0, 1.0);
  const double stride = walk.stride_rad;
  const double side = vigour * settings_.sway_side_m * std::sin(stride);
  const double bob = vigour * settings_.bob_m * std::cos(2.0 * stride);
  const double yaw = walk.heading_rad + vigour * settings_.sway_yaw_rad * std::sin(stride + 0.6);
  const double roll = vigour * settings_.sway_roll_rad * std::cos(stride);
  const double lean = vigour * (settings_.lean_rad + 0.3 * settings_.lean_rad * std::sin(2.0 * stride));
  const double swing = vigour * 0.35 * std::sin(stride);

  PersonPose pose;
  pose.walk = walk;
  pose.ripple_rad = stride + 0.25 * 2.0 * std::numbers::pi * clock_s;  // fifteen breaths a minute
  const Eigen::Vector3d hips(walk.x_m - side * std::sin(walk.heading_rad),
                             walk.y_m + side * std::cos(walk.heading_rad), kHipHeightM + bob);
  const Eigen::AngleAxisd turn(yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Isometry3d upright = Eigen::Translation3d(hips) * turn;
  const Eigen::Isometry3d torso_pose = upright * Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitY()) *
                                       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  const auto hanging = [](const Eigen::Isometry3d& parent, double y_m, double z_m, double forward_rad,
                          double outward_rad) -> Eigen::Isometry3d {
    return parent * Eigen::Translation3d(0.0, y_m, z_m) *
           Eigen::AngleAxisd(-forward_rad, Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(outward_rad, Eigen::Vector3d::UnitX());
  };
  pose.world_from_part[kTorso] = torso_pose;
  pose.world_from_part[kHead] = torso_pose;
  pose.world_from_part[kLeftArm] = hanging(torso_pose, kArmPivotYM, kShoulderZM, swing, 0.06);
  pose.world_from_part[kRightArm] = hanging(torso_pose, -kArmPivotYM, kShoulderZM, -swing, -0.06);
  pose.world_from_part[kLeftLeg] = hanging(upright, 0.1, -0.02, -swing, 0.0);
  pose.world_from_part[kRightLeg] = hanging(upright, -0.1, -0.02, swing, 0.0);
  return pose;
}

Mesh Person::torso_mesh(const PersonPose& pose) const {
  Mesh mesh = meshes_[kTorso];
  const auto amplitude = static_cast<float>(settings_.cloth_ripple_m);
  const auto phase = static_cast<float>(pose.ripple_rad);
  for (MeshVertex& vertex : mesh.vertices) {
    const float z = vertex.position_m.z();
    const float y = vertex.position_m.y();
    // Folds run aslant; the collar and the hem are held.
    const float hold = std::clamp((0.60f - z) / 0.15f, 0.f, 1.f);
    const float fold =
        std::sin(22.f * z + 9.f * y + phase) + 0.6f * std::sin(14.f * z - 17.f * y - 0.7f * phase);
    const float slope = std::cos(22.f * z + 9.f * y + phase);
    vertex.position_m += vertex.normal * (amplitude * hold * fold);
    vertex.normal.z() -= 22.f * amplitude * hold * slope;
    vertex.normal.normalize();
  }
  return mesh;
}

Eigen::Vector3d Person::back_centre_m() const {
  return torso_point(0.5, kBackCentreZM);
}

Eigen::Vector3d Person::shirt_point_m(double s_texel, double t_texel) const {
  const Mesh& mesh = meshes_[kTorso];
  const double column = std::clamp(s_texel / kShirtWidthTexels * kTorsoSegments, 0.0, kTorsoSegments - 1e-9);
  const double z = kTorsoTopM - t_texel / kShirtTexelsPerM;
  const double row = std::clamp((kTorsoTopM - z) / (kTorsoTopM - kTorsoBottomM) * (kTorsoRings - 1), 0.0,
                                kTorsoRings - 1 - 1e-9);
  const int j = static_cast<int>(column);
  const int k = static_cast<int>(row);
  const double u = column - j;
  const double v = row - k;
  const auto corner = [&](int dk, int dj) -> Eigen::Vector3d {
    return mesh.vertices[static_cast<std::size_t>((k + dk) * (kTorsoSegments + 1) + j + dj)]
        .position_m.cast<double>();
  };
  // The cell is two triangles: the upper left one and the lower right one.
  if (u + v <= 1.0)
    return corner(0, 0) + u * (corner(0, 1) - corner(0, 0)) + v * (corner(1, 0) - corner(0, 0));
  return corner(1, 1) + (1.0 - u) * (corner(1, 0) - corner(1, 1)) + (1.0 - v) * (corner(0, 1) - corner(1, 1));
}

}  // namespace heel::sim
