#include "vision/features/scale_space_fit.h"

#include <algorithm>
#include <cmath>

namespace heel {
namespace {

// In samples. More than half a sample, since box responses are far from quadratic and a stricter limit
// rejects repeatable peaks (repeatability on the Oxford pairs: 0.416 at 0.6, 0.433 at 1.0).
constexpr double kMaxOffset = 1.0;

bool is_first_maximum(const ResponseCube& cube) {
  const float centre = cube[1][1][1];
  bool before = true;
  for (const ResponsePatch& patch : cube) {
    for (const auto& row : patch) {
      for (const float& response : row) {
        if (&response == &cube[1][1][1]) {
          before = false;
        } else if (response > centre || (before && response == centre)) {
          return false;
        }
      }
    }
  }
  return true;
}

}  // namespace

std::optional<ScaleSpacePeak> fit_scale_space_peak(const ResponseCube& cube) {
  if (!is_first_maximum(cube)) return std::nullopt;
  const auto r = [&](int layer, int row, int dx) {
    return static_cast<double>(cube[static_cast<std::size_t>(layer + 1)][static_cast<std::size_t>(row + 1)]
                                   [static_cast<std::size_t>(dx + 1)]);
  };
  // Gradient g and Hessian H by central differences.
  const double centre = r(0, 0, 0);
  const double gx = 0.5 * (r(0, 0, 1) - r(0, 0, -1));
  const double gy = 0.5 * (r(0, 1, 0) - r(0, -1, 0));
  const double gs = 0.5 * (r(1, 0, 0) - r(-1, 0, 0));
  const double xx = r(0, 0, 1) - 2 * centre + r(0, 0, -1);
  const double yy = r(0, 1, 0) - 2 * centre + r(0, -1, 0);
  const double ss = r(1, 0, 0) - 2 * centre + r(-1, 0, 0);
  const double xy = 0.25 * (r(0, 1, 1) - r(0, 1, -1) - r(0, -1, 1) + r(0, -1, -1));
  const double xs = 0.25 * (r(1, 0, 1) - r(1, 0, -1) - r(-1, 0, 1) + r(-1, 0, -1));
  const double ys = 0.25 * (r(1, 1, 0) - r(1, -1, 0) - r(-1, 1, 0) + r(-1, -1, 0));
  // Solve H o = −g by Cramer's rule; at a peak H is negative definite.
  const double c00 = yy * ss - ys * ys, c01 = xs * ys - xy * ss, c02 = xy * ys - yy * xs;
  const double det = xx * c00 + xy * c01 + xs * c02;
  if (!(det < 0.0)) return std::nullopt;
  const double c11 = xx * ss - xs * xs, c12 = xy * xs - xx * ys, c22 = xx * yy - xy * xy;
  const double ox = -(c00 * gx + c01 * gy + c02 * gs) / det;
  const double oy = -(c01 * gx + c11 * gy + c12 * gs) / det;
  const double os = -(c02 * gx + c12 * gy + c22 * gs) / det;
  if (!(std::abs(ox) <= kMaxOffset && std::abs(oy) <= kMaxOffset && std::abs(os) <= kMaxOffset))
    return std::nullopt;
  ScaleSpacePeak peak;
  peak.dx = static_cast<float>(ox);
  peak.dy = static_cast<float>(oy);
  peak.dlayer = static_cast<float>(std::clamp(os, -0.5, 0.5));
  peak.response = static_cast<float>(centre + 0.5 * (gx * ox + gy * oy + gs * os));
  return peak;
}

}  // namespace heel
