#include "sim/scene/person.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace heel::sim {
namespace {

constexpr double kHipHeight_m = 0.92;
constexpr double kSeatedHipHeight_m = 0.54;
constexpr double kShoulderZ_m = 0.515;  ///< above the hips
constexpr double kArmPivotY_m = 0.213;
constexpr double kHipJointY_m = 0.095;
constexpr double kHipJointZ_m = -0.02;
constexpr double kSwing_rad = 0.38;       ///< of arms and thighs, to each side
constexpr double kKnee_rad = 0.75;        ///< bend of the knee that swings forwards
constexpr double kSeatedThigh_rad = 1.5;  ///< nearly level
constexpr double kRisingLean_rad = 0.45;  ///< when half seated
constexpr double kBreathRate_hz = 0.25;
constexpr double kPullPerBend_m_rad = 0.19;
constexpr double kDragPerFold = 0.45;      ///< of the cloth along the surface and along the normal
constexpr double kClothFollowsHips = 0.3;  ///< share of the hips' turn at the hem

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// The frame of a limb that hangs from (0, y, z) of its parent, swung forwards and outwards (to +y).
Isometry3d hanging(const Isometry3d& parent, double y_m, double z_m, double forward_rad, double outward_rad) {
  return parent * Eigen::Translation3d(0.0, y_m, z_m) * AngleAxisd(-forward_rad, Vector3d::UnitY()) *
         AngleAxisd(outward_rad, Vector3d::UnitX());
}

/// Poses the leg of one side; `phase` is that of its stride: the leg swings forwards during the first half.
void set_leg(PersonPose& pose, const Isometry3d& hips, bool left, double phase, double ahead, double aside) {
  const double seat = pose.walk.seat;
  const double side = left ? 1.0 : -1.0;
  const double swing = -kSwing_rad * std::cos(phase);
  const double lift = std::max(0.0, std::sin(phase));
  const double spread = 0.16 * aside * std::cos(phase);
  const double thigh_rad =
      ahead * swing + 0.35 * kKnee_rad * lift * std::abs(ahead) + seat * kSeatedThigh_rad;
  const double knee_rad =
      kKnee_rad * lift * (std::abs(ahead) + 0.5 * std::abs(aside)) + seat * kSeatedThigh_rad;
  const Isometry3d thigh = hanging(hips, side * kHipJointY_m, kHipJointZ_m, thigh_rad, side * 0.02 + spread);
  pose.world_from_part[left ? kLeftThigh : kRightThigh] = thigh;
  pose.world_from_part[left ? kLeftShin : kRightShin] = hanging(thigh, 0.0, -kThighLength_m, -knee_rad, 0.0);
}

}  // namespace

Person::Person(const PersonSettings& settings, std::uint64_t seed, std::uint64_t shirt_seed, WorldUse use)
    : settings_(settings), torso_(settings.torso, settings.depth, derived_seed(seed, 0x56)) {
  if (use == WorldUse::TruthOnly) return;
  const PersonGreys greys = random_greys(derived_seed(seed, 0x50));
  const Canvas shirt = draw_shirt(settings.shirt, shirt_seed);
  textures_.reserve(5);
  const auto surface = [this](Texture texture) {
    textures_.push_back(std::move(texture));
    return &textures_.back();
  };
  const Texture* print = surface(Texture(shirt));
  const Texture* head = surface(head_surface(greys, derived_seed(seed, 0x52)));
  const Texture* hair = surface(hair_surface(greys, derived_seed(seed, 0x55)));
  const Texture* arm = surface(arm_surface(greys, shirt, derived_seed(seed, 0x53)));
  const Texture* legs = surface(leg_surface(greys, derived_seed(seed, 0x54)));
  torso_.set_texture(*print);
  meshes_[kTorso] = torso_.at_rest();
  const auto set = [this](PersonPart part, Mesh mesh, const Texture* texture) {
    mesh.texture = texture;
    mesh.texels_per_m = 300.f;
    meshes_[static_cast<std::size_t>(part)] = std::move(mesh);
  };
  if (settings.torso == TorsoShape::Board) return;
  set(kHead, head_mesh(), head);
  set(kHair, hair_mesh(settings.hair), hair);
  set(kLeftArm, arm_mesh(), arm);
  set(kRightArm, arm_mesh(), arm);
  set(kLeftThigh, thigh_mesh(), legs);
  set(kRightThigh, thigh_mesh(), legs);
  set(kLeftShin, shin_mesh(), legs);
  set(kRightShin, shin_mesh(), legs);
}

PersonPose Person::pose(const WalkState& walk, double clock_s, const Posture& posture) const {
  // The gait grows with the speed, so that a standing person does not move.
  const double gait = std::clamp(walk.speed_m_s / 0.35, 0.0, 1.0);
  const double ahead = gait * std::cos(walk.travel_rad);
  const double aside = gait * std::sin(walk.travel_rad);
  const double stride = walk.stride_rad;
  const double side_m = gait * settings_.sway_side_m * std::sin(stride);
  const double bob_m = gait * settings_.bob_m * std::cos(2.0 * stride);
  const double sway = std::sin(stride + 0.6);
  const double chest_rad = gait * settings_.sway_yaw_rad * sway + posture.turn_rad;
  const double hips_rad = posture.turn_rad + posture.twist_rad - gait * settings_.hips_yaw_rad * sway;
  const double roll = gait * settings_.sway_roll_rad * std::cos(stride) + posture.roll_rad;
  const double lean = ahead * settings_.lean_rad * (1.0 + 0.3 * std::sin(2.0 * stride)) +
                      kRisingLean_rad * std::sin(std::numbers::pi * walk.seat) + posture.lean_rad;
  const double swing = ahead * kSwing_rad * std::sin(stride);
  const double breathing = 2.0 * std::numbers::pi * kBreathRate_hz * clock_s;

  PersonPose pose;
  pose.walk = walk;
  pose.cloth.settling = posture.settling;
  // A body that leans or twists pulls the whole shirt.
  const double bent_m =
      kPullPerBend_m_rad * std::hypot(posture.lean_rad, posture.roll_rad, posture.twist_rad);
  pose.cloth.pull_m = std::hypot(gait * settings_.cloth_pull_walking_m, bent_m);
  pose.cloth.fold_m = std::lerp(settings_.cloth_fold_m, settings_.cloth_fold_walking_m, gait);
  pose.cloth.drag_m = kDragPerFold * pose.cloth.fold_m;
  pose.cloth.stride_rad = stride;
  pose.cloth.twist_rad = kClothFollowsHips * (hips_rad - chest_rad);
  pose.cloth.breath_m = settings_.breath_m * (0.5 - 0.5 * std::cos(breathing));
  pose.cloth.slide_around_m = gait * settings_.cloth_slide_m * std::sin(stride - 0.4);
  pose.cloth.slide_up_m = 0.6 * gait * settings_.cloth_slide_m * std::cos(2.0 * stride);

  const double back_m = kSeatBehindFeet_m * walk.seat;
  const double c = std::cos(walk.heading_rad);
  const double s = std::sin(walk.heading_rad);
  const Vector3d hips(walk.x_m - side_m * s - back_m * c, walk.y_m + side_m * c - back_m * s,
                      kHipHeight_m + bob_m + walk.seat * (kSeatedHipHeight_m - kHipHeight_m));
  const Isometry3d pelvis =
      Eigen::Translation3d(hips) * AngleAxisd(walk.heading_rad + hips_rad, Vector3d::UnitZ());
  const Isometry3d torso = Eigen::Translation3d(hips) *
                           AngleAxisd(walk.heading_rad + chest_rad, Vector3d::UnitZ()) *
                           AngleAxisd(lean, Vector3d::UnitY()) * AngleAxisd(roll, Vector3d::UnitX());
  pose.world_from_part[kTorso] = torso;
  pose.world_from_part[kHead] = torso;
  pose.hips_forwards = pelvis.linear().col(0);
  // The hair hangs from the back of the head and follows the sway with a delay.
  pose.world_from_part[kHair] = hanging(torso, 0.0, kHairRootZ_m, 0.0, 0.12 * gait * std::sin(stride - 0.5));
  const double rest = 0.7 * walk.seat;  // hands on the knees
  pose.world_from_part[kLeftArm] = hanging(torso, kArmPivotY_m, kShoulderZ_m, swing + rest, 0.07);
  pose.world_from_part[kRightArm] = hanging(torso, -kArmPivotY_m, kShoulderZ_m, rest - swing, -0.07);
  // The left leg is foremost when the left arm is rearmost.
  const double phase = stride - 0.5 * std::numbers::pi;
  set_leg(pose, pelvis, true, phase + std::numbers::pi, ahead, aside);
  set_leg(pose, pelvis, false, phase, ahead, aside);
  return pose;
}

}  // namespace heel::sim
