#include "vision/features/orientation.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "vision/features/box_grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/features/orientation.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HEEL_VISION_ORIENTATION_WINDOW
#define HEEL_VISION_ORIENTATION_WINDOW
namespace heel::orientation_window {

inline constexpr float kSpacingPerSigma = 1.2f;
inline constexpr int kRadius = 6;                          // samples
inline constexpr int kReach = 2;                           // half a Haar wavelet's side
inline constexpr int kSide = 2 * kRadius + 1;              // responses along a side
inline constexpr int kLines = 2 * (kRadius + kReach) + 1;  // grid lines along a side
inline constexpr int kStride = 16;                         // from row to row of responses
inline constexpr std::size_t kBins = 144;                  // of 2.5°
inline constexpr std::size_t kWindowBins = kBins / 6;      // π/3

using Responses = std::array<float, kSide * kStride>;

struct Weights {
  HWY_ALIGN Responses at{};  // 0 outside the circle
  Weights() {
    constexpr double kWeightSigma = 2.5;  // samples
    for (int v = -kRadius; v <= kRadius; ++v) {
      for (int u = -kRadius; u <= kRadius; ++u) {
        if (u * u + v * v > kRadius * kRadius) continue;
        at[static_cast<std::size_t>((v + kRadius) * kStride + u + kRadius)] =
            static_cast<float>(std::exp(-(u * u + v * v) / (2.0 * kWeightSigma * kWeightSigma)));
      }
    }
  }
};
inline const Weights kWeights;

}  // namespace heel::orientation_window
#endif

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace orientation_window;
using F32 = hn::CappedTag<float, 16>;
using I32 = hn::RebindToSigned<F32>;

// atan2 to 1e-5 rad: the arctangent of min / max by a minimax polynomial on [0, 1], mapped to the octant (M.
// Abramowitz and I. Stegun, Handbook of Mathematical Functions, 4.4.47).
HWY_INLINE hn::Vec<F32> arc_tangent(hn::Vec<F32> y, hn::Vec<F32> x) {
  const F32 d;
  const auto ax = hn::Abs(x), ay = hn::Abs(y);
  const auto larger = hn::Max(hn::Max(ax, ay), hn::Set(d, 1e-30f));
  const auto t = hn::Div(hn::Min(ax, ay), larger);
  const auto t2 = hn::Mul(t, t);
  const auto step = [&](hn::Vec<F32> sum, float c) { return hn::Add(hn::Mul(sum, t2), hn::Set(d, c)); };
  auto angle =
      step(step(step(step(hn::Set(d, 0.0208351f), -0.0851330f), 0.1801410f), -0.3302995f), 0.9998660f);
  angle = hn::Mul(angle, t);
  constexpr float kPi = std::numbers::pi_v<float>;
  angle = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, kPi / 2), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, kPi), angle), angle);
  return hn::IfThenElse(hn::Lt(y, hn::Zero(d)), hn::Neg(angle), angle);
}

// Weighted Haar responses from the grid, and the bin of each one's angle.
void HaarResponses(const Patch& grid, Responses& dx, Responses& dy,
                   std::array<std::int32_t, kSide * kStride>& bin) {
  const F32 d;
  const I32 di;
  constexpr int kFull = 2 * kReach;
  const auto bins_per_rad = hn::Set(d, static_cast<float>(kBins) / (2.f * std::numbers::pi_v<float>));
  for (int v = 0; v < kSide; ++v) {
    for (int u = 0; u < kSide; u += static_cast<int>(hn::Lanes(d))) {
      const auto at = [&](int row, int column) {
        return hn::LoadU(d, grid.data() + (v + row) * kPatchStride + u + column);
      };
      const auto strip = [&](int column) { return hn::Sub(at(kFull, column), at(0, column)); };
      const auto line = [&](int row) { return hn::Sub(at(row, kFull), at(row, 0)); };
      const auto second_difference = [&](hn::Vec<F32> a, hn::Vec<F32> b, hn::Vec<F32> c) {
        return hn::Sub(hn::Sub(c, b), hn::Sub(b, a));
      };
      const std::size_t i = static_cast<std::size_t>(v * kStride + u);
      const auto weight = hn::LoadU(d, kWeights.at.data() + i);
      const auto x = hn::Mul(weight, second_difference(strip(0), strip(kReach), strip(kFull)));
      const auto y = hn::Mul(weight, second_difference(line(0), line(kReach), line(kFull)));
      const auto turn =
          hn::Mul(hn::Add(arc_tangent(y, x), hn::Set(d, std::numbers::pi_v<float>)), bins_per_rad);
      hn::StoreU(x, d, dx.data() + i);
      hn::StoreU(y, d, dy.data() + i);
      const auto last = hn::Set(di, static_cast<std::int32_t>(kBins - 1));
      hn::StoreU(hn::Min(hn::ConvertTo(di, turn), last), di, bin.data() + i);
    }
  }
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {

using namespace orientation_window;

HWY_EXPORT(HaarResponses);

float dominant_orientation(const IntegralImage& integral, const Feature& feature) {
  Patch grid;
  sample_upright_grid(integral, feature.x_px, feature.y_px, kSpacingPerSigma * feature.sigma_px, kLines,
                      grid);
  Responses dx, dy;
  // Filled at once: clearing it would cost time. NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
  std::array<std::int32_t, kSide * kStride> bin;
  HWY_DYNAMIC_DISPATCH(HaarResponses)(grid, dx, dy, bin);

  struct Vector {
    float dx = 0.f, dy = 0.f;
  };
  std::array<Vector, kBins> bins{};
  for (std::size_t v = 0; v < kSide; ++v) {
    for (std::size_t i = v * kStride; i < v * kStride + kSide; ++i) {
      Vector& sum = bins[static_cast<std::size_t>(bin[i])];
      sum.dx += dx[i];
      sum.dy += dy[i];
    }
  }
  // Cumulative sums over the circle and one window more: the sum of a window is the difference of two.
  std::array<Vector, kBins + kWindowBins> up_to;
  Vector total;
  for (std::size_t b = 0; b < up_to.size(); ++b) {
    up_to[b] = total;
    total.dx += bins[b % kBins].dx;
    total.dy += bins[b % kBins].dy;
  }
  float best_length = 0.f;
  Vector best{1.f, 0.f};
  for (std::size_t first = 0; first < kBins; ++first) {
    const Vector& end = up_to[first + kWindowBins];
    const Vector window{end.dx - up_to[first].dx, end.dy - up_to[first].dy};
    const float length = window.dx * window.dx + window.dy * window.dy;
    if (length > best_length) {
      best_length = length;
      best = window;
    }
  }
  return std::atan2(best.dy, best.dx);
}

}  // namespace heel
#endif  // HWY_ONCE
