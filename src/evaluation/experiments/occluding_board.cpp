#include "evaluation/experiments/occluding_board.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace heel::evaluation {
namespace {

constexpr int kCell_px = 9;
constexpr double kMargin = 0.6;  ///< of the board beyond the back, as a share of the back's size

}  // namespace

void draw_occluding_board(const sim::Truth& truth, const CameraModel& camera, double share,
                          std::uint64_t seed, double light, std::vector<std::uint8_t>& grey) {
  const Eigen::Vector3d& back = truth.back_in_camera_m;
  if (back.z() < 0.1) return;
  // The visible width shrinks with the cosine of the back's angle to the line of sight.
  const double aspect_rad = truth.yaw_rad - std::atan2(back.x(), back.z());
  const double half_width_px = camera.fx * kBackHalfWidth_m * std::abs(std::cos(aspect_rad)) / back.z();
  const double half_height_px = camera.fy * kBackHalfHeight_m / back.z();
  const double hidden_px = 2.0 * half_width_px * std::abs(share);
  double from_px = truth.back_px.x() - (1.0 + 2.0 * kMargin) * half_width_px;
  double to_px = truth.back_px.x() - half_width_px + hidden_px;
  if (share < 0.0) {
    from_px = truth.back_px.x() + half_width_px - hidden_px;
    to_px = truth.back_px.x() + (1.0 + 2.0 * kMargin) * half_width_px;
  }
  const auto clamped = [](double px, int size) {
    return std::clamp(static_cast<int>(std::lround(px)), 0, size);
  };
  const int x0 = clamped(from_px, camera.width_px), x1 = clamped(to_px, camera.width_px);
  const int y0 = clamped(truth.back_px.y() - (1.0 + kMargin) * half_height_px, camera.height_px);
  const int y1 = clamped(truth.back_px.y() + (1.0 + kMargin) * half_height_px, camera.height_px);

  Random random(seed);
  const int columns = (x1 - x0) / kCell_px + 1;
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(columns) * ((y1 - y0) / kCell_px + 1));
  for (std::uint8_t& cell : cells) cell = static_cast<std::uint8_t>(light * random.uniform(50.0, 200.0));
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const int cell = (y - y0) / kCell_px * columns + (x - x0) / kCell_px;
      const double noisy = cells[static_cast<std::size_t>(cell)] + 2.0 * random.normal();
      grey[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width_px) +
           static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(std::clamp(noisy, 0.0, 255.0));
    }
}

}  // namespace heel::evaluation
