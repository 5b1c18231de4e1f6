#include "heel-sim/world/body_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "heel-sim/world/random.h"

namespace heel::sim {
namespace {

/// One level of a rounded part of the body: an ellipse about (x_m, 0).
struct Ellipse {
  double z_m, x_m, half_depth_m, half_width_m;
};

// Head and neck, torso frame: crown, temples, nape, neck down into the collar.
constexpr Ellipse kHeadProfile[] = {{0.855, 0.015, 0.012, 0.012}, {0.845, 0.012, 0.050, 0.042},
                                    {0.825, 0.010, 0.078, 0.062}, {0.795, 0.010, 0.095, 0.074},
                                    {0.755, 0.012, 0.100, 0.078}, {0.715, 0.015, 0.096, 0.075},
                                    {0.680, 0.022, 0.082, 0.068}, {0.655, 0.020, 0.066, 0.058},
                                    {0.630, 0.008, 0.056, 0.054}, {0.580, 0.000, 0.058, 0.058}};

// An arm hanging from its shoulder joint: rounded shoulder, short sleeve, elbow, wrist, hand.
constexpr double kSleeveEndM = -0.272;
constexpr Ellipse kArmProfile[] = {
    {0.022, 0.0, 0.012, 0.012},  {0.014, 0.0, 0.034, 0.030}, {-0.01, 0.0, 0.052, 0.044},
    {-0.05, 0.0, 0.059, 0.049},  {-0.24, 0.0, 0.052, 0.045}, {-0.27, 0.0, 0.053, 0.046},
    {-0.274, 0.0, 0.043, 0.038}, {-0.36, 0.0, 0.042, 0.037}, {-0.53, 0.0, 0.028, 0.024},
    {-0.58, 0.0, 0.037, 0.020},  {-0.64, 0.0, 0.032, 0.017}, {-0.67, 0.0, 0.005, 0.004}};

constexpr int kPartTexels = 256;
constexpr double kPartTexelsDown = 250.0;  ///< from the first ellipse to the last

/// The surface through the ellipses; its texture goes once around and once down.
Mesh rounded(std::span<const Ellipse> profile) {
  constexpr int kSegments = 12;
  const double height_m = profile.front().z_m - profile.back().z_m;
  return tube(static_cast<int>(profile.size()), kSegments, [&](int k, int j) {
    const auto at = static_cast<std::size_t>(k);
    const Ellipse& here = profile[at];
    const Ellipse& above = profile[k > 0 ? at - 1 : at];
    const Ellipse& below = profile[std::min(at + 1, profile.size() - 1)];
    const double angle = 2.0 * std::numbers::pi * j / kSegments;
    const double c = std::cos(angle), s = std::sin(angle);
    const Eigen::Vector3d around(-here.half_depth_m * s, here.half_width_m * c, 0.0);
    const Eigen::Vector3d up((above.half_depth_m - below.half_depth_m) * c + above.x_m - below.x_m,
                             (above.half_width_m - below.half_width_m) * s, above.z_m - below.z_m);
    MeshVertex vertex;
    vertex.position_m =
        Eigen::Vector3d(here.x_m + here.half_depth_m * c, here.half_width_m * s, here.z_m).cast<float>();
    vertex.normal = around.cross(up).normalized().cast<float>();
    vertex.s_texel = static_cast<float>(kPartTexels) * static_cast<float>(j) / kSegments;
    vertex.t_texel = static_cast<float>(kPartTexelsDown * (profile.front().z_m - here.z_m) / height_m);
    return vertex;
  });
}

/// Height of a texture row of `rounded`.
double part_z_m(std::span<const Ellipse> profile, int y_texel) {
  return profile.front().z_m - (profile.front().z_m - profile.back().z_m) * y_texel / kPartTexelsDown;
}

/// A tapering limb hanging down from the origin.
Mesh limb(double length_m, double top_radius_m, double bottom_radius_m) {
  constexpr int kRings = 5;
  constexpr int kSegments = 10;
  Mesh mesh = tube(kRings, kSegments, [&](int k, int j) {
    const double share = static_cast<double>(k) / (kRings - 1);
    const double radius = top_radius_m + share * (bottom_radius_m - top_radius_m);
    const double angle = 2.0 * std::numbers::pi * j / kSegments;
    MeshVertex vertex;
    vertex.position_m =
        Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), -share * length_m).cast<float>();
    vertex.normal = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0).cast<float>();
    vertex.s_texel = 256.f * static_cast<float>(j) / kSegments;
    vertex.t_texel = static_cast<float>(share * length_m * 300.0);
    return vertex;
  });
  return mesh;
}

constexpr float kSkinGrey = 135.f, kHairGrey = 45.f, kSleeveGrey = 95.f, kTrousersGrey = 60.f;

/// One tone with some irregularity.
float uneven(float grey, double roughness, Random& random) {
  return std::clamp(grey + static_cast<float>(roughness * random.normal()), 2.f, 250.f);
}

}  // namespace

Mesh head_mesh() {
  return rounded(kHeadProfile);
}

Mesh arm_mesh() {
  return rounded(kArmProfile);
}

Mesh leg_mesh() {
  return limb(0.90, 0.088, 0.055);
}

Texture head_surface(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(kPartTexels, kPartTexels, kSkinGrey);
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) {
      const double hairline_m =
          0.735 + 0.06 * std::cos(2.0 * std::numbers::pi * x / kPartTexels) + 0.003 * random.normal();
      canvas.at(x, y) = part_z_m(kHeadProfile, y) > hairline_m ? uneven(kHairGrey, 12.0, random)
                                                               : uneven(kSkinGrey, 2.0, random);
    }
  return Texture(canvas);
}

Texture arm_surface(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(kPartTexels, kPartTexels, kSleeveGrey);
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x)
      canvas.at(x, y) = part_z_m(kArmProfile, y) > kSleeveEndM ? uneven(kSleeveGrey, 5.0, random)
                                                               : uneven(kSkinGrey, 2.0, random);
  return Texture(canvas);
}

Texture trousers_cloth(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(kPartTexels, kPartTexels, kTrousersGrey);
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) canvas.at(x, y) = uneven(kTrousersGrey, 6.0, random);
  return Texture(canvas);
}

}  // namespace heel::sim
