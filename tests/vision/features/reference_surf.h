// The reference implementation of SURF: as the paper defines it (H. Bay et al., CVIU 2008), in double
// precision, directly from the pixels, without an integral image and without code of the fast implementation.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "vision/features/test_image.h"

namespace heel::test {

/// Sum over pixel columns [x0, x1) and rows [y0, y1).
inline double box_sum(const TestImage& image, int x0, int y0, int x1, int y1) {
  double sum = 0.0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) sum += image.at(x, y);
  }
  return sum;
}

struct ReferenceHessian {
  double determinant;  ///< grey levels 0…1
  double trace;
};

/// Fig. 2 and Eq. (3): box-filter second derivatives at pixel (x, y), normalised by the filter's area.
inline ReferenceHessian reference_hessian(const TestImage& image, int x, int y, int side) {
  const int lobe = side / 3, half = side / 2, narrow = (lobe - 1) / 2;
  const double norm = 1.0 / (255.0 * side * side);
  // Three lobes 1, −2, 1 along one axis, 2 · lobe − 1 wide along the other.
  const double dxx = norm * (box_sum(image, x - half, y - lobe + 1, x + half + 1, y + lobe) -
                             3.0 * box_sum(image, x - narrow, y - lobe + 1, x + narrow + 1, y + lobe));
  const double dyy = norm * (box_sum(image, x - lobe + 1, y - half, x + lobe, y + half + 1) -
                             3.0 * box_sum(image, x - lobe + 1, y - narrow, x + lobe, y + narrow + 1));
  // Four squares, one pixel apart.
  const double dxy =
      norm *
      (box_sum(image, x - lobe, y - lobe, x, y) + box_sum(image, x + 1, y + 1, x + lobe + 1, y + lobe + 1) -
       box_sum(image, x + 1, y - lobe, x + lobe + 1, y) - box_sum(image, x - lobe, y + 1, x, y + lobe + 1));
  return {dxx * dyy - 0.81 * dxy * dxy, dxx + dyy};
}

/// Sum over the rectangle [x0, x1) × [y0, y1) of square pixels, pixel (i, j) covering i ± ½, j ± ½. Border
/// pixels are repeated outwards.
inline double fractional_box_sum(const TestImage& image, double x0, double y0, double x1, double y1) {
  double sum = 0.0;
  for (int y = static_cast<int>(std::floor(y0 + 0.5)); y - 0.5 < y1; ++y) {
    const double height = std::min(y1, y + 0.5) - std::max(y0, y - 0.5);
    for (int x = static_cast<int>(std::floor(x0 + 0.5)); x - 0.5 < x1; ++x) {
      const double width = std::min(x1, x + 0.5) - std::max(x0, x - 0.5);
      if (width <= 0.0 || height <= 0.0) continue;
      sum += width * height *
             image.at(std::clamp(x, 0, image.width_px - 1), std::clamp(y, 0, image.height_px - 1));
    }
  }
  return sum;
}

/// The descriptor as descriptor.h defines it, each response from its own four boxes.
inline std::array<double, 64> reference_descriptor(const TestImage& image, double x_px, double y_px,
                                                   double sigma_px, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  // u, v in sigmas, along and across the orientation.
  const auto box = [&](double u, double v) {
    const double x = x_px + sigma_px * (c * u - s * v), y = y_px + sigma_px * (s * u + c * v);
    return fractional_box_sum(image, x - sigma_px, y - sigma_px, x + sigma_px, y + sigma_px);
  };
  std::array<double, 64> descriptor{};
  for (int cell_y = 0; cell_y < 4; ++cell_y) {
    for (int cell_x = 0; cell_x < 4; ++cell_x) {
      std::array<double, 4> sums{};
      for (int j = 0; j < 9; ++j) {
        for (int i = 0; i < 9; ++i) {
          const double u = 5 * cell_x + i - 11.5, v = 5 * cell_y + j - 11.5;
          const double a = box(u - 0.5, v - 0.5), b = box(u + 0.5, v - 0.5);
          const double d = box(u - 0.5, v + 0.5), e = box(u + 0.5, v + 0.5);
          const double weight = std::exp(-((i - 4) * (i - 4) + (j - 4) * (j - 4)) / (2.0 * 2.0 * 2.0));
          sums[0] += weight * (b + e - a - d);
          sums[1] += weight * (d + e - a - b);
          sums[2] += weight * std::abs(b + e - a - d);
          sums[3] += weight * std::abs(d + e - a - b);
        }
      }
      const double off_x = cell_x - 1.5, off_y = cell_y - 1.5;
      const double weight = std::exp(-(off_x * off_x + off_y * off_y) / (2.0 * 1.5 * 1.5));
      for (std::size_t k = 0; k < 4; ++k)
        descriptor[static_cast<std::size_t>(16 * cell_y + 4 * cell_x) + k] = weight * sums[k];
    }
  }
  double norm2 = 0.0;
  for (const double value : descriptor) norm2 += value * value;
  for (double& value : descriptor) value /= std::sqrt(norm2);
  return descriptor;
}

/// The orientation as orientation.h defines it: every window of π/3 that begins at a response is evaluated.
inline double reference_orientation(const TestImage& image, double x_px, double y_px, double sigma_px) {
  struct Response {
    double dx, dy, angle;
  };
  std::vector<Response> responses;
  const double s = 1.2 * sigma_px;
  for (int v = -6; v <= 6; ++v) {
    for (int u = -6; u <= 6; ++u) {
      if (u * u + v * v > 36) continue;
      const double x = x_px + s * u, y = y_px + s * v;
      const double weight = std::exp(-(u * u + v * v) / (2.0 * 2.5 * 2.5));
      const double dx = fractional_box_sum(image, x, y - 2 * s, x + 2 * s, y + 2 * s) -
                        fractional_box_sum(image, x - 2 * s, y - 2 * s, x, y + 2 * s);
      const double dy = fractional_box_sum(image, x - 2 * s, y, x + 2 * s, y + 2 * s) -
                        fractional_box_sum(image, x - 2 * s, y - 2 * s, x + 2 * s, y);
      responses.push_back({weight * dx, weight * dy, std::atan2(dy, dx)});
    }
  }
  double best = 0.0, best_angle = 0.0;
  for (const Response& first : responses) {
    double dx = 0.0, dy = 0.0;
    for (const Response& response : responses) {
      const double turn = response.angle - first.angle;
      if (turn - 2 * std::numbers::pi * std::floor(turn / (2 * std::numbers::pi)) >= std::numbers::pi / 3)
        continue;
      dx += response.dx;
      dy += response.dy;
    }
    if (std::hypot(dx, dy) > best) {
      best = std::hypot(dx, dy);
      best_angle = std::atan2(dy, dx);
    }
  }
  return best_angle;
}

}  // namespace heel::test
