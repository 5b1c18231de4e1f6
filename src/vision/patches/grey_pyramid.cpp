#include "vision/patches/grey_pyramid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/patches/affine_samples.h"

namespace heel {
namespace {

// A picture is halved when steps are longer than this: √2 is midway between two levels.
constexpr double kLongStep_px = 1.42;

/// From pixels of the full picture to those of a level, 2^level times as large.
Eigen::Vector2d in_level(const Eigen::Vector2d& px, std::size_t level) {
  return (px.array() + 0.5).matrix() / static_cast<double>(1U << level) - Eigen::Vector2d::Constant(0.5);
}

}  // namespace

float GreyPyramid::at(const Eigen::Vector2d& px, std::size_t level) const {
  return levels_[level].at(in_level(px, level));
}

float GreyPyramid::Level::at(const Eigen::Vector2d& px) const {
  const double x = std::clamp(px.x(), 0.0, width_px - 1.001), y = std::clamp(px.y(), 0.0, height_px - 1.001);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float fx = static_cast<float>(x - column), fy = static_cast<float>(y - row);
  const float* p = grey.data() + static_cast<std::ptrdiff_t>(row) * width_px + column;
  const float upper = p[0] + fx * (p[1] - p[0]);
  const float lower = p[width_px] + fx * (p[width_px + 1] - p[width_px]);
  return upper + fy * (lower - upper);
}

/// Every pixel is the mean of 2 × 2 of this level's.
GreyPyramid::Level GreyPyramid::Level::half() const {
  Level half;
  half.width_px = width_px / 2;
  half.height_px = height_px / 2;
  half.grey.reserve(static_cast<std::size_t>(half.width_px) * static_cast<std::size_t>(half.height_px));
  for (int y = 0; y < half.height_px; ++y) {
    const float* upper = grey.data() + static_cast<std::ptrdiff_t>(2 * y) * width_px;
    const float* lower = upper + width_px;
    for (int x = 0; x < half.width_px; ++x, upper += 2, lower += 2)
      half.grey.push_back(0.25f * (upper[0] + upper[1] + lower[0] + lower[1]));
  }
  return half;
}

GreyPyramid::GreyPyramid(std::span<const std::uint8_t> grey, int width_px, int height_px) {
  levels_.push_back({width_px, height_px, {grey.begin(), grey.end()}});
  while (levels_.size() < kLevels) levels_.push_back(levels_.back().half());
}

bool GreyPyramid::sample(const Eigen::Vector2d& centre_px, const Eigen::Matrix2d& step_px, int side,
                         PatchSamples& out) const {
  const double step_length_px = std::sqrt(std::abs(step_px.determinant()));
  const std::size_t index = step_length_px > 2.0 * kLongStep_px ? 2 : step_length_px > kLongStep_px ? 1 : 0;
  const Level& level = levels_[index];
  const Eigen::Vector2d centre = in_level(centre_px, index);
  const Eigen::Matrix2d step = step_px / static_cast<double>(1U << index);

  const double reach = 0.5 * (side - 1);
  const Eigen::Vector2d extent = reach * step.cwiseAbs().rowwise().sum();
  const Eigen::Vector2d last = centre + extent;
  if (!((centre - extent).minCoeff() >= 0.0) || !(last.x() < level.width_px - 1.01) ||
      !(last.y() < level.height_px - 1.01))
    return false;
  sample_affine(level.grey.data(), level.width_px, centre, step, side, out.data());
  return true;
}

}  // namespace heel
