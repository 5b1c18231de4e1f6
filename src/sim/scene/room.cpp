#include "sim/scene/room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "sim/scene/decor.h"

namespace heel::sim {
namespace {

constexpr double kCeiling_m = 3.0;
constexpr double kPatch_m = 2.0;  ///< light is interpolated linearly over a patch

double distance_to_walk(const FloorPlan& plan, const Eigen::Vector2d& point) {
  double nearest = std::numeric_limits<double>::max();
  for (const Eigen::Vector2d& walked : plan.walked_m) nearest = std::min(nearest, (walked - point).norm());
  return nearest;
}

}  // namespace

Room::Room(const RoomSettings& settings, const FloorPlan& plan, const Light& light, double window_azimuth_rad,
           std::uint64_t seed, WorldUse use)
    : light_(light), use_(use) {
  Eigen::Vector2d low = plan.walked_m.front();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& point : plan.walked_m) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  for (const ObstacleSettings& obstacle : plan.obstacles) {
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(0.5 * obstacle.length_m);
    low = low.cwiseMin(Eigen::Vector2d(obstacle.x_m, obstacle.y_m) - reach);
    high = high.cwiseMax(Eigen::Vector2d(obstacle.x_m, obstacle.y_m) + reach);
  }
  low.array() -= settings.margin_m;
  high.array() += settings.margin_m;
  add_shell(low, high, derived_seed(seed, 0x21));
  add_windows(settings, low, high, window_azimuth_rad);
  add_obstacles(plan, derived_seed(seed, 0x23));
  add_objects(settings, plan, low, high, derived_seed(seed, 0x22));
}

void Room::add_rectangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& right,
                         const Eigen::Vector3d& down, const Texture& texture, double texels_per_m,
                         const Eigen::Vector2d& texture_origin, double patch_m) {
  const int columns = std::max(1, static_cast<int>(std::ceil(right.norm() / patch_m)));
  const int rows = std::max(1, static_cast<int>(std::ceil(down.norm() / patch_m)));
  const Eigen::Vector3f normal = down.cross(right).normalized().cast<float>();
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      StaticFace face;
      face.texture = &texture;
      face.texels_per_m = static_cast<float>(texels_per_m);
      // Corner order: top left, bottom left, top right: counter-clockwise from outside.
      constexpr std::array<std::array<int, 2>, 3> kCorners{{{0, 0}, {0, 1}, {1, 0}}};
      for (std::size_t i = 0; i < kCorners.size(); ++i) {
        const double u = static_cast<double>(column + kCorners[i][0]) / columns;
        const double v = static_cast<double>(row + kCorners[i][1]) / rows;
        face.corners_m[i] = (origin + u * right + v * down).cast<float>();
        face.s_texel[i] = static_cast<float>(texture_origin.x() + u * right.norm() * texels_per_m);
        face.t_texel[i] = static_cast<float>(texture_origin.y() + v * down.norm() * texels_per_m);
        face.light[i] = light_.at(face.corners_m[i], normal);
      }
      faces_.push_back(face);
    }
  }
}

const Texture& Room::add_texture(const std::function<Canvas()>& draw) {
  return textures_.emplace_back(use_ == WorldUse::TruthOnly ? Canvas(1, 1, 0.f) : draw());
}

void Room::add_block(const Block& block, const Texture& texture) {
  constexpr double kTexelsPerM = 350.0;
  const Eigen::Vector3d along(std::cos(block.heading_rad), std::sin(block.heading_rad), 0.0);
  const Eigen::Vector3d left(-along.y(), along.x(), 0.0);
  const Eigen::Vector3d top(block.centre_m.x(), block.centre_m.y(), block.top_m);
  const Eigen::Vector3d down(0.0, 0.0, block.bottom_m - block.top_m);
  const Eigen::Vector3d half_along = 0.5 * block.length_m * along;
  const Eigen::Vector3d half_left = 0.5 * block.width_m * left;
  // Seen from above, `right` goes counter-clockwise around the block.
  add_rectangle(top - half_along - half_left, 2.0 * half_along, down, texture, kTexelsPerM, {0, 0}, kPatch_m);
  add_rectangle(top + half_along - half_left, 2.0 * half_left, down, texture, kTexelsPerM, {170, 60},
                kPatch_m);
  add_rectangle(top + half_along + half_left, -2.0 * half_along, down, texture, kTexelsPerM, {300, 0},
                kPatch_m);
  add_rectangle(top - half_along + half_left, -2.0 * half_left, down, texture, kTexelsPerM, {80, 200},
                kPatch_m);
  add_rectangle(top - half_along + half_left, 2.0 * half_along, -2.0 * half_left, texture, kTexelsPerM,
                {0, 300}, kPatch_m);
  if (block.bottom_m > 0.0)
    add_rectangle(top + down - half_along - half_left, 2.0 * half_along, 2.0 * half_left, texture,
                  kTexelsPerM, {0, 300}, kPatch_m);
  else
    footprints_.push_back(
        {block.centre_m, block.heading_rad, block.length_m, block.width_m, 0.0, block.top_m});
}

/// A prism with twelve sides.
void Room::add_pole(const ObstacleSettings& pole, const Texture& texture) {
  constexpr int kSides = 12;
  constexpr double kTexelsPerM = 350.0;
  const Eigen::Vector3d down(0.0, 0.0, -pole.height_m);
  const auto corner = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    return Eigen::Vector3d(pole.x_m + pole.radius_m * std::cos(angle),
                           pole.y_m + pole.radius_m * std::sin(angle), pole.height_m);
  };
  for (int i = 0; i < kSides; ++i) {
    const Eigen::Vector3d right = corner(i + 1) - corner(i);
    add_rectangle(corner(i), right, down, texture, kTexelsPerM, {i * right.norm() * kTexelsPerM, 0},
                  kPatch_m);
  }
  footprints_.push_back({{pole.x_m, pole.y_m}, 0.0, 0.0, 0.0, pole.radius_m, pole.height_m});
}

void Room::add_obstacles(const FloorPlan& plan, std::uint64_t seed) {
  const Texture& plaster = add_texture([&] { return draw_plaster(derived_seed(seed, 1)); });
  const Texture& crate = add_texture([&] { return draw_crate(derived_seed(seed, 2)); });
  for (const ObstacleSettings& obstacle : plan.obstacles) {
    if (obstacle.kind == ObstacleKind::Pole) add_pole(obstacle, plaster);
    for (const Block& block : blocks_of(obstacle))
      add_block(block, obstacle.kind == ObstacleKind::Box ? crate : plaster);
  }
  for (const StoolPlace& stool : plan.stools)
    add_block({{stool.x_m, stool.y_m}, stool.heading_rad, kStoolSide_m, kStoolSide_m, 0.0, kStoolHeight_m},
              crate);
}

/// A row of windows, evenly spaced along the wall in the direction of the azimuth.
void Room::add_windows(const RoomSettings& settings, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                       double azimuth_rad) {
  if (settings.windows <= 0) return;
  constexpr double kWidth_m = 1.6, kHeight_m = 1.3, kTop_m = 2.4, kBeforeWall_m = 0.02;
  const Texture& texture = add_texture([&] { return draw_window(); });
  const double c = std::cos(azimuth_rad);
  const double s = std::sin(azimuth_rad);
  const bool along_y = std::abs(c) >= std::abs(s);  // the wall's direction
  const double wall = along_y ? (c > 0 ? high.x() - kBeforeWall_m : low.x() + kBeforeWall_m)
                              : (s > 0 ? high.y() - kBeforeWall_m : low.y() + kBeforeWall_m);
  const double from = along_y ? low.y() : low.x();
  const double to = along_y ? high.y() : high.x();
  // To the right as seen from inside.
  const Eigen::Vector3d right =
      along_y ? Eigen::Vector3d(0, c > 0 ? -1 : 1, 0) : Eigen::Vector3d(s > 0 ? 1 : -1, 0, 0);
  const std::size_t first = faces_.size();
  for (int i = 0; i < settings.windows; ++i) {
    const double at = from + (to - from) * (i + 0.5) / settings.windows;
    const Eigen::Vector3d middle =
        along_y ? Eigen::Vector3d(wall, at, kTop_m) : Eigen::Vector3d(at, wall, kTop_m);
    add_rectangle(middle - 0.5 * kWidth_m * right, kWidth_m * right, {0, 0, -kHeight_m}, texture,
                  512.0 / kWidth_m, {0, 0}, kPatch_m);
  }
  for (std::size_t i = first; i < faces_.size(); ++i)
    faces_[i].light.fill(static_cast<float>(settings.window_light));
}

void Room::add_shell(const Eigen::Vector2d& low, const Eigen::Vector2d& high, std::uint64_t seed) {
  const Eigen::Vector2d size = high - low;
  const Texture& floor = add_texture([&] { return draw_floor(derived_seed(seed, 1)); });
  const Texture& ceiling = add_texture([&] { return draw_ceiling(derived_seed(seed, 2)); });
  add_rectangle({low.x(), high.y(), 0.0}, {size.x(), 0, 0}, {0, -size.y(), 0}, floor, 256.0, {0, 0},
                kPatch_m);
  add_rectangle({low.x(), low.y(), kCeiling_m}, {size.x(), 0, 0}, {0, size.y(), 0}, ceiling, 100.0, {0, 0},
                kPatch_m);
  // The walls face inwards: `right` goes clockwise around the room.
  const Eigen::Vector3d down(0, 0, -kCeiling_m);
  const std::array<Eigen::Vector3d, 4> corners{{{low.x(), low.y(), kCeiling_m},
                                                {low.x(), high.y(), kCeiling_m},
                                                {high.x(), high.y(), kCeiling_m},
                                                {high.x(), low.y(), kCeiling_m}}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Texture& wall = add_texture([&] { return draw_wall(derived_seed(seed, 10 + i)); });
    add_rectangle(corners[i], corners[(i + 1) % 4] - corners[i], down, wall, 512.0 / kCeiling_m, {0, 0},
                  kPatch_m);
  }
  const Eigen::Vector2d middle = 0.5 * (low + high);
  constexpr double kThick_m = 0.2;  // outside the room
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector2d out = 0.5 * side * (size.array() + kThick_m).matrix();
    footprints_.push_back({{middle.x() + out.x(), middle.y()}, 0.0, kThick_m, size.y(), 0.0, kCeiling_m});
    footprints_.push_back({{middle.x(), middle.y() + out.y()}, 0.0, size.x(), kThick_m, 0.0, kCeiling_m});
  }
}

void Room::add_objects(const RoomSettings& settings, const FloorPlan& plan, const Eigen::Vector2d& low,
                       const Eigen::Vector2d& high, std::uint64_t seed) {
  Random random(seed);
  std::vector<const Texture*> crates, shelves, pin_boards;
  for (int i = 0; i < 3; ++i) {
    crates.push_back(&add_texture([&] { return draw_crate(derived_seed(seed, 20 + i)); }));
    shelves.push_back(&add_texture([&] { return draw_shelf(derived_seed(seed, 30 + i)); }));
    pin_boards.push_back(&add_texture([&] { return draw_pin_board(derived_seed(seed, 40 + i)); }));
  }
  int placed = 0;
  // The number of tries is limited: a crowded room may not have space for all objects.
  for (int tries = 0; tries < 50 * settings.objects && placed < settings.objects; ++tries) {
    const Eigen::Vector2d centre(random.uniform(low.x() + 0.6, high.x() - 0.6),
                                 random.uniform(low.y() + 0.6, high.y() - 0.6));
    const double heading = random.uniform(0, std::numbers::pi);
    const double kind = random.uniform();
    Eigen::Vector3d size(random.uniform(0.4, 0.9), random.uniform(0.4, 0.9), random.uniform(0.4, 1.3));
    const auto pick = static_cast<std::size_t>(random.index(3));
    const Texture* texture = crates[pick];
    if (kind > 0.65) {
      size = {random.uniform(1.0, 1.5), 0.06, random.uniform(1.5, 2.0)};
      texture = pin_boards[pick];
    } else if (kind > 0.4) {
      size = {random.uniform(0.8, 1.2), 0.35, random.uniform(1.4, 2.2)};
      texture = shelves[pick];
    }
    const double reach = 0.5 * size.head<2>().norm();
    if (distance_to_walk(plan, centre) < settings.clearance_m + reach) continue;
    if (std::any_of(plan.obstacles.begin(), plan.obstacles.end(), [&](const ObstacleSettings& o) {
          const double clear = reach + 0.3 + (o.kind == ObstacleKind::Pole ? o.radius_m : 0.5 * o.length_m);
          return (centre - Eigen::Vector2d(o.x_m, o.y_m)).norm() < clear;
        }))
      continue;
    add_block({centre, heading, size.x(), size.y(), 0.0, size.z()}, *texture);
    ++placed;
  }
}

}  // namespace heel::sim
