#include "sim/scene/prints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "sim/scene/letters.h"
#include "sim/scene/paint.h"
#include "sim/scene/shirts.h"

namespace heel::sim {
namespace {

constexpr double kMiddle = 0.5 * kShirtWidthTexels;
/// The cloth that can be seen from behind and beside, in texels down from the collar.
constexpr double kHem = 700.0;

float grey_between(double low, double high, Random& random) {
  return static_cast<float>(random.uniform(low, high));
}

/// A star of `points` points, as a signed distance that is exact enough for an edge of one texel.
double star_distance(double x, double y, double radius, int points) {
  const double angle = std::atan2(y, x) * points / (2.0 * std::numbers::pi);
  const double across = std::abs(angle - std::round(angle)) * 2.0;  // 0 at a tip, 1 between two
  return 0.7 * (length(x, y) - radius * (1.0 - 0.55 * across));
}

/// One shape of many: star, ring, disc, ellipse, bar, half ring, triangle or crescent.
void draw_shape(Canvas& canvas, int kind, double cx, double cy, double radius, double angle, float grey) {
  const double c = std::cos(angle), s = std::sin(angle);
  paint(canvas, box_around(cx, cy, 1.3 * radius), grey, [&](int px, int py) {
    const double x = c * (px - cx) + s * (py - cy);
    const double y = -s * (px - cx) + c * (py - cy);
    const double ring = std::abs(length(x, y) - 0.8 * radius) - 0.17 * radius;
    switch (kind) {
      case 0:
        return star_distance(x, y, 1.2 * radius, 7);
      case 1:
        return ring;
      case 2:
        return length(x, y) - 0.7 * radius;
      case 3:
        return 0.6 * (length(x, 1.7 * y) - radius);
      case 4:
        return rectangle_distance(x, y, 1.15 * radius, 0.15 * radius);
      case 5:
        return std::max(ring, y);
      case 6:
        return std::max(
            {y - 0.5 * radius, 0.866 * x - 0.5 * y - 0.6 * radius, -0.866 * x - 0.5 * y - 0.6 * radius});
      default:
        return std::max(length(x, y) - 0.8 * radius, 0.75 * radius - length(x - 0.5 * radius, y));
    }
  });
}

/// A smooth random field with details of all sizes from `coarsest` texels down to a sixteenth of it: the sum
/// of interpolated random lattices. About −1 … 1.
class Clouds {
 public:
  Clouds(double coarsest, Random& random) : coarsest_(coarsest) {
    for (double& value : lattice_) value = random.uniform(-1.0, 1.0);
  }
  double at(double x, double y) const {
    double sum = 0.0, size = coarsest_, weight = 0.55;
    for (int octave = 0; octave < 5; ++octave, size *= 0.5, weight *= 0.55)
      sum += weight * smooth(x / size + 17 * octave, y / size + 29 * octave);
    return sum;
  }

 private:
  static constexpr int kSide = 64;
  double value(int x, int y) const {
    return lattice_[static_cast<std::size_t>((y & (kSide - 1)) * kSide + (x & (kSide - 1)))];
  }
  double smooth(double x, double y) const {
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const auto ease = [](double f) { return f * f * (3.0 - 2.0 * f); };
    const double fx = ease(x - x0), fy = ease(y - y0);
    return std::lerp(std::lerp(value(x0, y0), value(x0 + 1, y0), fx),
                     std::lerp(value(x0, y0 + 1), value(x0 + 1, y0 + 1), fx), fy);
  }
  double coarsest_;
  std::array<double, static_cast<std::size_t>(kSide) * kSide> lattice_{};
};

/// The line of a mountain ridge: height at x, from a few slopes.
class Ridge {
 public:
  Ridge(double left, double right, double base, double height, int peaks, Random& random) {
    for (int i = 0; i <= 2 * peaks; ++i) {
      x_.push_back(left + (right - left) * (i + random.uniform(-0.3, 0.3)) / (2 * peaks));
      y_.push_back(i % 2 == 0 ? base : base - height * random.uniform(0.5, 1.0));
    }
  }
  double at(double x) const {
    std::size_t i = 0;
    while (i + 2 < x_.size() && x > x_[i + 1]) ++i;
    return std::lerp(y_[i], y_[i + 1], std::clamp((x - x_[i]) / (x_[i + 1] - x_[i]), 0.0, 1.0));
  }

 private:
  std::vector<double> x_, y_;
};

constexpr std::array<std::string_view, 16> kWords{"NORTH", "RIVER", "HARBOUR", "CLUB", "RUN",    "SUMMER",
                                                  "COAST", "TEAM",  "WINTER",  "CREW", "VALLEY", "RACE",
                                                  "TOUR",  "OPEN",  "GARDEN",  "MUSIC"};

std::string_view any_word(Random& random) {
  return kWords[static_cast<std::size_t>(random.index(static_cast<int>(kWords.size())))];
}

/// Lit windows: dots in rows and columns, most of them dark.
void draw_lights(Canvas& canvas, double left, double right, double top, double bottom, Random& random) {
  for (double x = left; x < right - 20;) {
    const double width = random.uniform(18, 42);
    const double roof = std::lerp(top, bottom, random.uniform(0.0, 0.4));
    const float wall = grey_between(12, 38, random);
    paint(
        canvas,
        {static_cast<int>(x), static_cast<int>(roof), static_cast<int>(x + width), static_cast<int>(bottom)},
        wall, [](int, int) { return -1.0; }, 0.7f);
    const int floors = static_cast<int>(std::ceil((bottom - roof - 14) / 8));
    const int windows = static_cast<int>(std::ceil((width - 7) / 6));  // on each floor
    for (int floor = 0; floor < floors; ++floor) {
      for (int window = 0; window < windows; ++window) {
        if (random.uniform() >= 0.36) continue;
        const double wx = x + 4 + 6 * window, wy = roof + 6 + 8 * floor;
        paint(canvas, box_around(wx, wy, 3), grey_between(110, 225, random),
              [&](int px, int py) { return rectangle_distance(px - wx, py - wy, 1.5, 2.0); });
      }
    }
    x += width + random.uniform(0, 8);
  }
}

}  // namespace

void draw_shapes(Canvas& canvas, Random& random) {
  struct Placed {
    double x, y, radius;
  };
  std::vector<Placed> placed;
  constexpr std::array<float, 7> kInks{18.f, 42.f, 62.f, 82.f, 96.f, 120.f, 160.f};
  for (int tries = 0; tries < 1500; ++tries) {
    const double radius = tries < 200 ? random.uniform(34, 60) : random.uniform(9, 34);
    const Placed here{random.uniform(0, canvas.width()), random.uniform(0, kHem), radius};
    // Shapes may touch, as on a print that is drawn by hand, but hardly overlap.
    if (std::any_of(placed.begin(), placed.end(), [&](const Placed& other) {
          return length(here.x - other.x, here.y - other.y) < 0.95 * (here.radius + other.radius) + 4.0;
        }))
      continue;
    placed.push_back(here);
    draw_shape(canvas, random.index(8), here.x, here.y, radius, random.uniform(0, 2 * std::numbers::pi),
               kInks[static_cast<std::size_t>(random.index(static_cast<int>(kInks.size())))]);
    if (placed.size() >= 150) break;
  }
}

void draw_emblem(Canvas& canvas, Random& random) {
  // A shield, or a disc, of some twenty centimetres, between the shoulder blades.
  const bool shield = random.uniform() < 0.6;
  const double cy = random.uniform(275, 300), half = random.uniform(112, 125);
  const auto outline = [&](double x, double y) {
    if (!shield) return length(x, y) - 1.1 * half;
    const double point = std::max(0.0, y - 0.15 * half);
    return std::max(rectangle_distance(x, y, half, 1.3 * half), 0.8 * (std::abs(x) + 0.85 * point - half));
  };
  const Box2 box = box_around(kMiddle, cy, 1.4 * half);
  const auto over = [&](double inset) {
    return [&, inset](int px, int py) { return outline(px - kMiddle, py - cy) + inset; };
  };
  paint(canvas, box, grey_between(190, 225, random), over(0.0));
  paint(canvas, box, grey_between(12, 30, random), over(15.0));
  // Mountains with snow, a moon, a name, and a few strokes.
  const double base = cy + 0.45 * half;
  for (const double side : {-1.0, 1.0}) {
    const double peak_x = kMiddle + side * random.uniform(0.2, 0.4) * half;
    const double peak_y = base - random.uniform(0.6, 1.1) * half;
    const auto slope = [&](int px, int py) {
      return std::max({0.75 * (std::abs(px - peak_x) * 1.5 - (py - peak_y)), py - base - 0.35 * half,
                       outline(px - kMiddle, py - cy) + 17.0});
    };
    paint(canvas, box, grey_between(95, 150, random), slope);
    paint(canvas, box, 205.f,
          [&](int px, int py) { return std::max(slope(px, py), py - peak_y - 0.2 * half); });
  }
  draw_shape(canvas, 7, kMiddle - 0.5 * half, cy - 0.6 * half, 0.2 * half, random.uniform(0, 6), 200.f);
  const std::string_view name = any_word(random);
  const double cell = std::min(3.4, (shield ? 0.9 : 0.7) * half / word_width(name, 1.0));
  draw_word(canvas, name, kMiddle - 0.15 * half, cy - (shield ? 0.75 : 0.55) * half, cell, 205.f);
  for (int i = 0; i < 6; ++i)
    draw_shape(canvas, 4, kMiddle + random.uniform(-0.5, 0.5) * half, base + random.uniform(0.0, 0.25) * half,
               random.uniform(8, 16), random.uniform(0.6, 1.2), 20.f);
}

void draw_photo(Canvas& canvas, Random& random) {
  // A town below mountains, in the evening: soft above, small lights below.
  const double left = kMiddle - 155, right = kMiddle + 155, top = 85, bottom = 600;
  const double horizon = std::lerp(top, bottom, random.uniform(0.42, 0.5));
  const Clouds clouds(130.0, random), ground(60.0, random);
  const Ridge far(left, right, horizon + 25, 95, 4, random), near(left, right, horizon + 60, 70, 5, random);
  const double sky = random.uniform(105, 130), far_grey = random.uniform(62, 80),
               near_grey = random.uniform(40, 52);
  for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y)
    for (int x = static_cast<int>(left); x < static_cast<int>(right); ++x) {
      double grey = sky + 75.0 * clouds.at(x, y) - 25.0 * (y - top) / (bottom - top);
      if (y > far.at(x)) grey = far_grey + 12.0 * clouds.at(2.0 * x, 2.0 * y);
      if (y > near.at(x)) grey = near_grey + 14.0 * ground.at(x, y);
      canvas.at(x, y) = static_cast<float>(std::clamp(grey, 8.0, 235.0));
    }
  draw_lights(canvas, left + 8, right - 8, horizon + 40, bottom - 15, random);
}

void draw_text(Canvas& canvas, Random& random) {
  // Lines of words, centred, of different height: the back of a shirt from an event.
  double y = random.uniform(130, 165);
  const float ink = canvas.at(0, 0) < 110.f ? 225.f : 25.f;
  while (y < 520) {
    const std::string_view word = any_word(random);
    const double cell = std::min(random.uniform(4.0, 11.0), 290.0 / word_width(word, 1.0));
    draw_word(canvas, word, kMiddle - 0.5 * word_width(word, cell), y, cell, ink);
    y += 7.0 * cell + random.uniform(12, 26);
  }
}

}  // namespace heel::sim
