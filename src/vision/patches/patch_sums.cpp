#include "vision/patches/patch_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace heel {
namespace {

// Sums by lanes, added in a fixed order: the compiler makes vector instructions of them, and every processor
// gives the same result.
constexpr std::size_t kLanes = 8;
using Lanes = std::array<float, kLanes>;

float total(const Lanes& l) {
  return ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
}

float sum_of(const PatchSamples& a, std::size_t padded) {
  Lanes sums{};
  for (std::size_t i = 0; i < padded; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += a[i + lane];
  return total(sums);
}

float product_of(const PatchSamples& a, const PatchSamples& b, std::size_t padded) {
  Lanes sums{};
  for (std::size_t i = 0; i < padded; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  return total(sums);
}

void remove_mean(PatchSamples& samples, std::size_t count, std::size_t padded) {
  const float mean = sum_of(samples, padded) / static_cast<float>(count);
  for (std::size_t i = 0; i < count; ++i) samples[i] -= mean;
}

/// Bilinear samples, less `base`: sums of small numbers are exact enough in floats.
void sample_frame(const std::uint8_t* first, std::ptrdiff_t stride, int side,
                  const std::array<float, 4>& weights, float base, PatchSamples& out) {
  float* value = out.data();
  for (int row = 0; row < side; ++row, value += side) {
    const std::uint8_t* upper = first + row * stride;
    const std::uint8_t* lower = upper + stride;
    for (int column = 0; column < side; ++column)
      value[column] = weights[0] * upper[column] + weights[1] * upper[column + 1] +
                      weights[2] * lower[column] + weights[3] * lower[column + 1] - base;
  }
}

}  // namespace

PatchModel::PatchModel(const PatchSamples& warped, int side) : side_(side), count_(side * side) {
  const auto count = static_cast<std::size_t>(side * side);
  padded_ = (count + kLanes - 1) / kLanes * kLanes;
  for (std::size_t i = padded_ - kLanes; i < padded_; ++i) value_[i] = by_x_[i] = by_y_[i] = 0.f;
  const int wide = side + 2;
  for (int row = 0; row < side; ++row) {
    const float* p = warped.data() + (row + 1) * wide + 1;
    const auto start = static_cast<std::size_t>(row * side);
    for (int column = 0; column < side; ++column, ++p) {
      const std::size_t i = start + static_cast<std::size_t>(column);
      value_[i] = *p;
      by_x_[i] = 0.5f * (p[1] - p[-1]);
      by_y_[i] = 0.5f * (p[wide] - p[-wide]);
    }
  }
  for (PatchSamples* samples : {&value_, &by_x_, &by_y_}) remove_mean(*samples, count, padded_);
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
  if (left < 0 || top < 0 || left + side_ + 1 >= static_cast<int>(frame.header.width_px) ||
      top + side_ + 1 >= static_cast<int>(frame.header.height_px))
    return std::nullopt;
  const auto stride = static_cast<std::ptrdiff_t>(frame.stride_bytes);
  const std::uint8_t* first = frame.grey + top * stride + left;
  const float fx = static_cast<float>(first_px.x() - left), fy = static_cast<float>(first_px.y() - top);
  PatchSamples samples;
  for (std::size_t i = padded_ - kLanes; i < padded_; ++i) samples[i] = 0.f;
  sample_frame(first, stride, side_, {(1.f - fx) * (1.f - fy), fx * (1.f - fy), (1.f - fx) * fy, fx * fy},
               first[(side_ / 2) * stride + side_ / 2], samples);

  Lanes s{}, ss{}, sv{}, sx{}, sy{};
  for (std::size_t i = 0; i < padded_; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float sample = samples[i + lane];
      s[lane] += sample;
      ss[lane] += sample * sample;
      sv[lane] += sample * value_[i + lane];
      sx[lane] += sample * by_x_[i + lane];
      sy[lane] += sample * by_y_[i + lane];
    }
  }
  // The model has no mean, so the frame's own changes no product with it.
  const double sum = total(s), squares = total(ss) - sum * sum / count_;
  if (!(squares > 0.0)) return PatchComparison{};
  const double gain = std::sqrt(squares_ / squares);
  return PatchComparison{squares / count_,
                         total(sv) / std::sqrt(squares * squares_),
                         {gain * total(sx) - value_x_, gain * total(sy) - value_y_}};
}

}  // namespace heel
