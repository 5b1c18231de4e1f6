#include "sim/scene/body_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "core/random.h"
#include "heel/error.h"
#include "sim/scene/shirts.h"

namespace heel::sim {
namespace {

/// A horizontal section of a rounded part of the body: an ellipse with its centre at (x_m, 0).
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
constexpr double kSleeveEnd_m = -0.272;
constexpr Ellipse kArmProfile[] = {
    {0.022, 0.0, 0.012, 0.012},  {0.014, 0.0, 0.034, 0.030}, {-0.01, 0.0, 0.052, 0.044},
    {-0.05, 0.0, 0.059, 0.049},  {-0.24, 0.0, 0.052, 0.045}, {-0.27, 0.0, 0.053, 0.046},
    {-0.274, 0.0, 0.043, 0.038}, {-0.36, 0.0, 0.042, 0.037}, {-0.53, 0.0, 0.028, 0.024},
    {-0.58, 0.0, 0.037, 0.020},  {-0.64, 0.0, 0.032, 0.017}, {-0.67, 0.0, 0.005, 0.004}};

// Thigh from the hip joint, and shin with the shoe from the knee.
constexpr Ellipse kThighProfile[] = {{0.060, 0.0, 0.070, 0.070},
                                     {0.000, -0.01, 0.092, 0.090},
                                     {-0.12, 0.0, 0.088, 0.084},
                                     {-0.30, 0.0, 0.070, 0.066},
                                     {-kThighLength_m, 0.0, 0.058, 0.056}};
constexpr Ellipse kShinProfile[] = {{0.030, 0.005, 0.052, 0.050}, {-0.05, 0.0, 0.058, 0.056},
                                    {-0.18, -0.01, 0.060, 0.057}, {-0.38, -0.01, 0.050, 0.050},
                                    {-0.40, 0.03, 0.090, 0.042},  {-0.44, 0.06, 0.125, 0.047},
                                    {-0.47, 0.06, 0.130, 0.048},  {-0.472, 0.06, 0.01, 0.01}};
constexpr double kShoeTop_m = -0.395;

// Hanging hair, from kHairRootZ_m: a bundle, or a curtain over the shoulder blades.
constexpr Ellipse kShortHairProfile[] = {
    {0.0, -0.05, 0.030, 0.040}, {-0.02, -0.05, 0.034, 0.044}, {-0.05, -0.045, 0.02, 0.03}};
constexpr Ellipse kPonytailProfile[] = {{0.02, -0.085, 0.012, 0.012},  {0.00, -0.105, 0.026, 0.024},
                                        {-0.06, -0.125, 0.030, 0.030}, {-0.18, -0.130, 0.026, 0.032},
                                        {-0.30, -0.135, 0.018, 0.026}, {-0.36, -0.138, 0.006, 0.008}};
constexpr Ellipse kLongHairProfile[] = {
    {0.085, 0.00, 0.05, 0.05},     {0.06, -0.005, 0.095, 0.078},  {0.00, -0.010, 0.104, 0.088},
    {-0.08, -0.030, 0.095, 0.098}, {-0.15, -0.085, 0.050, 0.115}, {-0.22, -0.118, 0.030, 0.122},
    {-0.32, -0.130, 0.024, 0.118}, {-0.40, -0.134, 0.020, 0.105}, {-0.43, -0.136, 0.008, 0.070}};

constexpr int kPartTexels = 256;
constexpr double kPartTexelsDown = 250.0;  ///< from the first ellipse to the last

/// The surface through the ellipses; the texture covers it once around and once down.
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

/// `grey` with random roughness.
float uneven(float grey, double roughness, Random& random) {
  return std::clamp(grey + static_cast<float>(roughness * random.normal()), 2.f, 250.f);
}

/// A texture with grey(x, y) at every texel, computed row by row.
template <typename Grey>
Texture surface(const Grey& grey) {
  Canvas canvas(kPartTexels, kPartTexels, 0.f);
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) canvas.at(x, y) = grey(x, y);
  return Texture(canvas);
}

}  // namespace

Hair hair_style(const std::string& name) {
  if (name == "short") return Hair::Short;
  if (name == "ponytail") return Hair::Ponytail;
  if (name == "long") return Hair::Long;
  throw Error("'" + name + "' (expected a hair style: short, ponytail or long)");
}

Mesh head_mesh() {
  return rounded(kHeadProfile);
}

Mesh hair_mesh(Hair style) {
  if (style == Hair::Long) return rounded(kLongHairProfile);
  return style == Hair::Ponytail ? rounded(kPonytailProfile) : rounded(kShortHairProfile);
}

Mesh arm_mesh() {
  return rounded(kArmProfile);
}

Mesh thigh_mesh() {
  Mesh mesh = rounded(kThighProfile);
  // Trousers only: the shoe is in the last quarter of the surface.
  for (MeshVertex& vertex : mesh.vertices) vertex.t_texel *= 0.75f;
  return mesh;
}

Mesh shin_mesh() {
  return rounded(kShinProfile);
}

PersonGreys random_greys(std::uint64_t seed) {
  Random random(seed);
  PersonGreys greys{};
  greys.skin = static_cast<float>(random.uniform(85, 165));
  greys.hair = static_cast<float>(random.uniform(30, 95));
  greys.trousers = static_cast<float>(random.uniform(40, 100));
  greys.shoes = static_cast<float>(random.uniform(20, 60));
  return greys;
}

Texture head_surface(const PersonGreys& greys, std::uint64_t seed) {
  Random random(seed);
  return surface([&](int x, int y) {
    const double hairline_m =
        0.735 + 0.06 * std::cos(2.0 * std::numbers::pi * x / kPartTexels) + 0.003 * random.normal();
    const double z_m = part_z_m(kHeadProfile, y);
    if (z_m > hairline_m) return uneven(greys.hair, 12.0, random);
    // Eyes and mouth show which way the person faces: the front is at x = 0.
    const int from_front = std::min(x, kPartTexels - x);
    const bool eye = std::abs(from_front - 15) < 5 && std::abs(z_m - 0.745) < 0.007;
    const bool mouth = from_front < 12 && std::abs(z_m - 0.685) < 0.005;
    return uneven(eye || mouth ? 0.4f * greys.skin : greys.skin, 2.0, random);
  });
}

Texture hair_surface(const PersonGreys& greys, std::uint64_t seed) {
  Random random(seed);
  // Strands: each column has one grey level, with a little noise.
  std::array<float, kPartTexels> strand{};
  for (float& grey : strand) grey = uneven(greys.hair, 10.0, random);
  return surface([&](int x, int /*y*/) { return uneven(strand[static_cast<std::size_t>(x)], 4.0, random); });
}

Texture arm_surface(const PersonGreys& greys, const Canvas& shirt, std::uint64_t seed) {
  Random random(seed);
  // The sleeve is cut from the cloth beside the back: about 1000 texels a metre both ways.
  constexpr double kTexelsAround = 320.0 / kPartTexels;
  const double texels_down = kShirtTexelsPerM * (part_z_m(kArmProfile, 0) - part_z_m(kArmProfile, 1));
  return surface([&](int x, int y) {
    if (part_z_m(kArmProfile, y) <= kSleeveEnd_m) return uneven(greys.skin, 2.0, random);
    return shirt.at(static_cast<int>(x * kTexelsAround), 600 + static_cast<int>(y * texels_down));
  });
}

Texture leg_surface(const PersonGreys& greys, std::uint64_t seed) {
  Random random(seed);
  return surface([&](int /*x*/, int y) {
    return part_z_m(kShinProfile, y) > kShoeTop_m ? uneven(greys.trousers, 6.0, random)
                                                  : uneven(greys.shoes, 3.0, random);
  });
}

}  // namespace heel::sim
