#include "sim/scene/decor.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "sim/scene/paint.h"

namespace heel::sim {
namespace {

void fill_box(Canvas& canvas, double x, double y, double width, double height, float grey) {
  const Box2 box{static_cast<int>(x) - 1, static_cast<int>(y) - 1, static_cast<int>(x + width) + 2,
                 static_cast<int>(y + height) + 2};
  paint(canvas, box, grey, [&](int px, int py) {
    return rectangle_distance(px - x - width / 2, py - y - height / 2, width / 2, height / 2);
  });
}

float random_grey(Random& random) {
  return static_cast<float>(random.uniform(25, 235));
}

/// A sheet of paper with a frame, a few shapes and some lines of "text".
void draw_sheet(Canvas& canvas, double x, double y, double width, double height, Random& random) {
  const bool dark = random.uniform() < 0.35;
  const float paper = static_cast<float>(dark ? random.uniform(30, 90) : random.uniform(170, 240));
  const float ink = static_cast<float>(dark ? random.uniform(170, 230) : random.uniform(20, 90));
  fill_box(canvas, x, y, width, height, ink);
  const double edge = 0.03 * std::min(width, height) + 1;
  fill_box(canvas, x + edge, y + edge, width - 2 * edge, height - 2 * edge, paper);
  const int shapes = 2 + random.index(5);
  for (int i = 0; i < shapes; ++i) {
    const double radius = random.uniform(0.05, 0.2) * std::min(width, height);
    const double cx = random.uniform(x + radius + edge, x + width - radius - edge);
    const double cy = random.uniform(y + radius + edge, y + 0.6 * height);
    const bool ring = random.uniform() < 0.4;
    paint(canvas, box_around(cx, cy, radius), random.uniform() < 0.5 ? ink : random_grey(random),
          [&](int px, int py) {
            const double r = length(px - cx, py - cy);
            return ring ? std::abs(r - 0.75 * radius) - 0.25 * radius : r - radius;
          });
  }
  const double line = std::max(2.0, 0.02 * height);
  double ty = y + 0.65 * height;
  while (ty < y + height - 3 * line - edge) {
    double tx = x + 2 * edge + 2;
    while (tx < x + width - 2 * edge - 6) {
      const double word = std::min(random.uniform(2, 9) * line, x + width - 2 * edge - 2 - tx);
      fill_box(canvas, tx, ty, word, line, ink);
      tx += word + 1.5 * line;
    }
    ty += 2.2 * line;
  }
}

/// Rows of book spines of random width, height and grey.
void draw_books(Canvas& canvas, double x, double y, double width, double height, double row, Random& random) {
  fill_box(canvas, x, y, width, height, 40.f);
  for (double ty = y + 2; ty + row <= y + height; ty += row) {
    double tx = x + 3;
    while (tx < x + width - 14) {
      const double spine = random.uniform(4, 13);
      const double tall = row * random.uniform(0.6, 0.92);
      fill_box(canvas, tx, ty + row - tall, spine - 1, tall - 3, random_grey(random));
      if (random.uniform() < 0.6)
        fill_box(canvas, tx + 1, ty + row - 0.8 * tall, spine - 3, 3, random_grey(random));
      tx += spine;
    }
  }
}

struct Interval {
  double low, high;
};

/// Discs of random place, radius and grey level all over the canvas.
void draw_random_discs(Canvas& canvas, int count, const Interval& radius_texel, const Interval& grey,
                       float opacity, Random& random) {
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(0, canvas.width());
    const double y = random.uniform(0, canvas.height());
    const double radius = random.uniform(radius_texel.low, radius_texel.high);
    paint(
        canvas, box_around(x, y, radius), static_cast<float>(random.uniform(grey.low, grey.high)),
        [&](int px, int py) { return length(px - x, py - y) - radius; }, opacity);
  }
}

}  // namespace

Canvas draw_floor(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(1024, 1024, 120.f);
  constexpr int kTile = 128;
  for (int ty = 0; ty < 1024; ty += kTile)
    for (int tx = 0; tx < 1024; tx += kTile) {
      const float tone = static_cast<float>(random.uniform(95, 145));
      fill_box(canvas, tx + 1, ty + 1, kTile - 3, kTile - 3, tone);
    }
  draw_random_discs(canvas, 2500, {1.5, 6}, {60, 180}, 0.6f, random);
  add_grain(canvas, 6.0, random);
  return canvas;
}

Canvas draw_wall(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(4096, 512, static_cast<float>(random.uniform(130, 180)));
  fill_box(canvas, 0, 495, 4096, 17, 60.f);  // skirting board
  double x = 40;
  while (x < 3900) {
    const double kind = random.uniform();
    if (kind < 0.15) {  // a door
      fill_box(canvas, x, 150, 160, 350, 70.f);
      fill_box(canvas, x + 8, 158, 144, 342, static_cast<float>(random.uniform(90, 200)));
      fill_box(canvas, x + 125, 330, 16, 8, 30.f);
      x += 190;
    } else if (kind < 0.45) {  // a shelf
      const double width = random.uniform(150, 350);
      draw_books(canvas, x, 140, width, 350, random.uniform(40, 60), random);
      x += width + 25;
    } else if (kind < 0.9) {  // one or two posters
      const double width = random.uniform(60, 170);
      const double height = random.uniform(80, 190);
      draw_sheet(canvas, x, random.uniform(90, 200), width, height, random);
      if (random.uniform() < 0.5)
        draw_sheet(canvas, x + 5, random.uniform(395, 410), width * 0.7, 70, random);
      x += width + random.uniform(10, 50);
    } else {
      x += random.uniform(30, 120);
    }
  }
  add_grain(canvas, 3.0, random);
  return canvas;
}

Canvas draw_ceiling(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(512, 512, 190.f);
  for (int y = 0; y < 512; y += 128)
    for (int x = 0; x < 512; x += 128)
      fill_box(canvas, x + 2, y + 2, 124, 124, static_cast<float>(random.uniform(180, 210)));
  fill_box(canvas, 130, 150, 124, 84, 245.f);
  add_grain(canvas, 3.0, random);
  return canvas;
}

Canvas draw_crate(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(512, 512, 60.f);
  for (double y = 0; y < 512;) {
    const double board = random.uniform(40, 80);
    fill_box(canvas, 0, y, 512, board - 4, static_cast<float>(random.uniform(100, 170)));
    y += board;
  }
  for (int i = 0; i < 7; ++i)
    draw_sheet(canvas, random.uniform(0, 400), random.uniform(0, 400), random.uniform(50, 110),
               random.uniform(50, 110), random);
  for (int i = 0; i < 120; ++i) {
    const double x = random.uniform(0, 512);
    const double y = random.uniform(0, 512);
    paint(canvas, box_around(x, y, 4), 35.f, [&](int px, int py) { return length(px - x, py - y) - 3.5; });
  }
  add_grain(canvas, 5.0, random);
  return canvas;
}

Canvas draw_shelf(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(512, 512, 60.f);
  draw_books(canvas, 0, 0, 512, 512, 64, random);
  add_grain(canvas, 4.0, random);
  return canvas;
}

Canvas draw_pin_board(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(512, 512, static_cast<float>(random.uniform(90, 150)));
  for (int i = 0; i < 22; ++i)
    draw_sheet(canvas, random.uniform(0, 420), random.uniform(0, 400), random.uniform(50, 120),
               random.uniform(60, 140), random);
  add_grain(canvas, 4.0, random);
  return canvas;
}

Canvas draw_plaster(std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(512, 512, static_cast<float>(random.uniform(140, 185)));
  draw_random_discs(canvas, 400, {3, 22}, {110, 200}, 0.08f, random);
  add_grain(canvas, 4.0, random);
  return canvas;
}

Canvas draw_window() {
  Canvas canvas(512, 256, 40.f);
  for (int pane = 0; pane < 4; ++pane) fill_box(canvas, pane * 128 + 6, 8, 116, 240, 235.f);
  return canvas;
}

}  // namespace heel::sim
