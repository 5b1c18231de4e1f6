#include "vision/patches/affine_samples.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/patches/affine_samples.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F32 = hn::CappedTag<float, kSampleRowPadding + 1>;
using I32 = hn::RebindToSigned<F32>;

HWY_INLINE hn::Vec<F32> lerp(hn::Vec<F32> a, hn::Vec<F32> b, hn::Vec<F32> t) {
  return hn::Add(a, hn::Mul(t, hn::Sub(b, a)));
}

void SampleAffineRow(const float* grey, std::int32_t stride, float first_x, float first_y, float step_x,
                     float step_y, int side, float* out) {
  const F32 d;
  const I32 di;
  // Lanes past the last sample repeat it, so that none reads outside of the picture.
  const auto last = hn::Set(d, static_cast<float>(side - 1));
  for (int column = 0; column < side; column += static_cast<int>(hn::Lanes(d))) {
    const auto columns = hn::Min(hn::Iota(d, static_cast<float>(column)), last);
    const auto x = hn::Add(hn::Set(d, first_x), hn::Mul(columns, hn::Set(d, step_x)));
    const auto y = hn::Add(hn::Set(d, first_y), hn::Mul(columns, hn::Set(d, step_y)));
    const auto whole_x = hn::ConvertTo(di, x), whole_y = hn::ConvertTo(di, y);
    const auto fx = hn::Sub(x, hn::ConvertTo(d, whole_x)), fy = hn::Sub(y, hn::ConvertTo(d, whole_y));
    const auto index = hn::Add(hn::Mul(whole_y, hn::Set(di, stride)), whole_x);
    const auto at = [&](std::int32_t offset) { return hn::GatherIndex(d, grey + offset, index); };
    const auto upper = lerp(at(0), at(1), fx), lower = lerp(at(stride), at(stride + 1), fx);
    hn::StoreU(lerp(upper, lower, fy), d, out + column);
  }
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {

HWY_EXPORT(SampleAffineRow);

void sample_affine(const float* grey, int stride, const Eigen::Vector2d& centre_px,
                   const Eigen::Matrix2d& step_px, int side, float* out) {
  const double reach = 0.5 * (side - 1);
  const float step_x = static_cast<float>(step_px(0, 0)), step_y = static_cast<float>(step_px(1, 0));
  for (int row = 0; row < side; ++row, out += side) {
    const Eigen::Vector2d first = centre_px - reach * step_px.col(0) + (row - reach) * step_px.col(1);
    HWY_DYNAMIC_DISPATCH(SampleAffineRow)
    (grey, stride, static_cast<float>(first.x()), static_cast<float>(first.y()), step_x, step_y, side, out);
  }
}

}  // namespace heel
#endif  // HWY_ONCE
