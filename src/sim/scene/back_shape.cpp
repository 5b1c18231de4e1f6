#include "sim/scene/back_shape.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace heel::sim {
namespace {

constexpr double kOutside = 1.17;  ///< the polynomial would rise too fast farther outside

struct Spread {
  double mean_mm, deviation_mm;
};
// Polynomial terms of the depth: fitted to three bodies together (mean), and to each (deviation).
constexpr Spread kU{0.0, 4.5}, kU2{-13.3, 8.0}, kU4{49.2, 6.0}, kV{-10.2, 3.5}, kV2{-11.1, 4.0},
    kV3{-6.1, 2.0}, kU2V{13.1, 4.5}, kUV{0.0, 2.5};

double draw_m(const Spread& spread, Random& random) {
  // Two deviations at most: the figures come from few bodies.
  return 1e-3 * (spread.mean_mm + spread.deviation_mm * std::clamp(random.normal(), -2.0, 2.0));
}

}  // namespace

BackShape::BackShape(double depth, std::uint64_t seed) {
  Random random(seed);
  u1_ = draw_m(kU, random);
  u2_ = depth * draw_m(kU2, random);
  u4_ = depth * draw_m(kU4, random);
  v1_ = draw_m(kV, random);
  v2_ = draw_m(kV2, random);
  v3_ = draw_m(kV3, random);
  u2v_ = draw_m(kU2V, random);
  uv_ = draw_m(kUV, random);
  for (const double side : {-1.0, 1.0})
    blades_[side > 0 ? 1 : 0] = {side * random.uniform(0.45, 0.58), random.uniform(-0.6, -0.4),
                                 random.uniform(0.003, 0.009), 0.27, 0.28};
  spine_ = {0.0, random.uniform(-0.5, -0.1), -random.uniform(0.002, 0.008), 0.17, 0.55};
}

double BackShape::depth_m(double u_in, double v_in) const {
  const double u = std::clamp(u_in, -kOutside, kOutside);
  const double v = std::clamp(v_in, -kOutside, kOutside);
  const double u2 = u * u;
  double depth_m =
      u * u1_ + u2 * (u2_ + u2 * u4_) + v * (v1_ + v * (v2_ + v * v3_)) + u2 * v * u2v_ + u * v * uv_;
  const auto add = [&](const Bump& bump) {
    const double du = (u - bump.u) / bump.half_u;
    const double dv = (v - bump.v) / bump.half_v;
    depth_m -= bump.height_m * std::exp(-0.5 * (du * du + dv * dv));
  };
  add(blades_[0]);
  add(blades_[1]);
  add(spine_);
  return depth_m;
}

}  // namespace heel::sim
