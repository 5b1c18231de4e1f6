#include "vision/patches/patch_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/patches/patch_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HEEL_VISION_PATCH_SUM_LANES
#define HEEL_VISION_PATCH_SUM_LANES
namespace heel::patch_sum_lanes {

// Sums by lanes, added in a fixed order, so that every processor gives the same result.
inline constexpr std::size_t kLanes = 8;
using Lanes = std::array<float, kLanes>;

inline float total(const Lanes& l) {
  return ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
}

// Where in the frame a patch is sampled.
struct FrameSquare {
  const std::uint8_t* first;
  std::ptrdiff_t stride;
  std::array<float, 4> weights;  // bilinear: upper left, upper right, lower left, lower right
  float base;                    // subtracted: sums of small numbers are exact enough in floats
};

// Of the samples and the model: s, s², s·value, s·d/dx, s·d/dy.
using ComparisonSums = std::array<float, 5>;

}  // namespace heel::patch_sum_lanes
#endif

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace patch_sum_lanes;
using F32 = hn::CappedTag<float, kLanes>;

// A sum in kLanes lanes, whatever the processor's vectors hold.
class LaneSum {
 public:
  HWY_INLINE LaneSum() { std::fill_n(parts_, kParts, hn::Zero(F32())); }
  HWY_INLINE void add(std::size_t part, hn::Vec<F32> v) { parts_[part] = hn::Add(parts_[part], v); }
  HWY_INLINE float total() const {
    HWY_ALIGN Lanes lanes;
    for (std::size_t part = 0; part < kParts; ++part)
      hn::Store(parts_[part], F32(), lanes.data() + part * hn::MaxLanes(F32()));
    return patch_sum_lanes::total(lanes);
  }
  static constexpr std::size_t kParts = kLanes / hn::MaxLanes(F32());

 private:
  hn::Vec<F32> parts_[kParts];
};

// Calls `add(part, i)` for every vector of samples.
template <class Add>
HWY_INLINE void for_each_vector(std::size_t padded, const Add& add) {
  for (std::size_t i = 0; i < padded; i += kLanes)
    for (std::size_t part = 0; part < LaneSum::kParts; ++part) add(part, i + part * hn::MaxLanes(F32()));
}

float SumOf(const float* a, std::size_t padded) {
  const F32 d;
  LaneSum sum;
  for_each_vector(padded, [&](std::size_t part, std::size_t i) { sum.add(part, hn::LoadU(d, a + i)); });
  return sum.total();
}

float ProductOf(const float* a, const float* b, std::size_t padded) {
  const F32 d;
  LaneSum sum;
  for_each_vector(padded, [&](std::size_t part, std::size_t i) {
    sum.add(part, hn::Mul(hn::LoadU(d, a + i), hn::LoadU(d, b + i)));
  });
  return sum.total();
}

// Rows are written whole vectors at a time; what lies past a row's end the next row replaces.
void SampleFrame(const FrameSquare& square, int side, float* out) {
  const F32 d;
  const hn::Rebind<std::int32_t, F32> di;
  const hn::Rebind<std::uint8_t, F32> d8;
  const auto at = [&](const std::uint8_t* p) {
    return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, p)));
  };
  const auto w0 = hn::Set(d, square.weights[0]), w1 = hn::Set(d, square.weights[1]);
  const auto w2 = hn::Set(d, square.weights[2]), w3 = hn::Set(d, square.weights[3]);
  const auto base = hn::Set(d, square.base);
  for (int row = 0; row < side; ++row, out += side) {
    const std::uint8_t* upper = square.first + row * square.stride;
    const std::uint8_t* lower = upper + square.stride;
    for (int column = 0; column < side; column += static_cast<int>(hn::Lanes(d))) {
      const auto above = hn::Add(hn::Mul(w0, at(upper + column)), hn::Mul(w1, at(upper + column + 1)));
      const auto with_left = hn::Add(above, hn::Mul(w2, at(lower + column)));
      const auto sample = hn::Add(with_left, hn::Mul(w3, at(lower + column + 1)));
      hn::StoreU(hn::Sub(sample, base), d, out + column);
    }
  }
}

ComparisonSums Compare(const float* samples, const float* value, const float* by_x, const float* by_y,
                       std::size_t padded) {
  const F32 d;
  LaneSum s, ss, sv, sx, sy;
  for_each_vector(padded, [&](std::size_t part, std::size_t i) {
    const auto sample = hn::LoadU(d, samples + i);
    s.add(part, sample);
    ss.add(part, hn::Mul(sample, sample));
    sv.add(part, hn::Mul(sample, hn::LoadU(d, value + i)));
    sx.add(part, hn::Mul(sample, hn::LoadU(d, by_x + i)));
    sy.add(part, hn::Mul(sample, hn::LoadU(d, by_y + i)));
  });
  return {s.total(), ss.total(), sv.total(), sx.total(), sy.total()};
}

// The inner samples of `warped` and their derivatives.
void Differentiate(const float* warped, int side, float* value, float* by_x, float* by_y) {
  const F32 d;
  const auto half = hn::Set(d, 0.5f);
  const int wide = side + 2;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; column += static_cast<int>(hn::Lanes(d))) {
      const float* p = warped + (row + 1) * wide + 1 + column;
      const int i = row * side + column;
      hn::StoreU(hn::LoadU(d, p), d, value + i);
      hn::StoreU(hn::Mul(half, hn::Sub(hn::LoadU(d, p + 1), hn::LoadU(d, p - 1))), d, by_x + i);
      hn::StoreU(hn::Mul(half, hn::Sub(hn::LoadU(d, p + wide), hn::LoadU(d, p - wide))), d, by_y + i);
    }
  }
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {

using namespace patch_sum_lanes;

HWY_EXPORT(SumOf);
HWY_EXPORT(ProductOf);
HWY_EXPORT(SampleFrame);
HWY_EXPORT(Compare);
HWY_EXPORT(Differentiate);

namespace {

float product_of(const PatchSamples& a, const PatchSamples& b, std::size_t padded) {
  return HWY_DYNAMIC_DISPATCH(ProductOf)(a.data(), b.data(), padded);
}

void clear_padding(PatchSamples& samples, std::size_t count, std::size_t padded) {
  for (std::size_t i = count; i < padded; ++i) samples[i] = 0.f;
}

void remove_mean(PatchSamples& samples, std::size_t count, std::size_t padded) {
  const float mean = HWY_DYNAMIC_DISPATCH(SumOf)(samples.data(), padded) / static_cast<float>(count);
  for (std::size_t i = 0; i < count; ++i) samples[i] -= mean;
}

}  // namespace

PatchModel::PatchModel(const PatchSamples& warped, int side) : side_(side), count_(side * side) {
  const auto count = static_cast<std::size_t>(side * side);
  padded_ = (count + kLanes - 1) / kLanes * kLanes;
  HWY_DYNAMIC_DISPATCH(Differentiate)(warped.data(), side, value_.data(), by_x_.data(), by_y_.data());
  for (PatchSamples* samples : {&value_, &by_x_, &by_y_}) {
    clear_padding(*samples, count, padded_);
    remove_mean(*samples, count, padded_);
  }
  squares_ = product_of(value_, value_, padded_);
  xx_ = product_of(by_x_, by_x_, padded_);
  xy_ = product_of(by_x_, by_y_, padded_);
  yy_ = product_of(by_y_, by_y_, padded_);
  value_x_ = product_of(value_, by_x_, padded_);
  value_y_ = product_of(value_, by_y_, padded_);
}

Eigen::Matrix2d PatchModel::hessian() const {
  Eigen::Matrix2d hessian;
  hessian << xx_, xy_, xy_, yy_;
  return hessian;
}

std::optional<PatchComparison> PatchModel::compare(const FrameView& frame,
                                                   const Eigen::Vector2d& first_px) const {
  const int left = static_cast<int>(std::floor(first_px.x())),
            top = static_cast<int>(std::floor(first_px.y()));
  // The row below is not sampled: vectors that end past the last column read on into it.
  if (left < 0 || top < 0 || left + side_ + 1 >= static_cast<int>(frame.header.width_px) ||
      top + side_ + 1 >= static_cast<int>(frame.header.height_px))
    return std::nullopt;
  const auto stride = static_cast<std::ptrdiff_t>(frame.stride_bytes);
  const std::uint8_t* first = frame.grey + top * stride + left;
  const float fx = static_cast<float>(first_px.x() - left), fy = static_cast<float>(first_px.y() - top);
  const std::ptrdiff_t middle = side_ / 2;
  PatchSamples samples;
  HWY_DYNAMIC_DISPATCH(SampleFrame)
  ({first,
    stride,
    {(1.f - fx) * (1.f - fy), fx * (1.f - fy), (1.f - fx) * fy, fx * fy},
    static_cast<float>(first[middle * stride + middle])},
   side_, samples.data());
  clear_padding(samples, static_cast<std::size_t>(side_ * side_), padded_);

  // The model has no mean, so the frame's own changes no product with it.
  const auto [sum_of_samples, sum_of_squares, by_value, by_x, by_y] =
      HWY_DYNAMIC_DISPATCH(Compare)(samples.data(), value_.data(), by_x_.data(), by_y_.data(), padded_);
  const double sum = sum_of_samples, squares = sum_of_squares - sum * sum / count_;
  if (!(squares > 0.0)) return PatchComparison{};
  const double gain = std::sqrt(squares_ / squares);
  return PatchComparison{squares / count_,
                         by_value / std::sqrt(squares * squares_),
                         {gain * by_x - value_x_, gain * by_y - value_y_}};
}

}  // namespace heel
#endif  // HWY_ONCE
