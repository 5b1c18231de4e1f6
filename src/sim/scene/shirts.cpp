#include "sim/scene/shirts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "heel/error.h"
#include "sim/scene/paint.h"
#include "sim/scene/prints.h"

namespace heel::sim {
namespace {

/// The fine texture of woven cloth.
void weave(Canvas& canvas, double strength, Random& random) {
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x)
      canvas.at(x, y) += static_cast<float>(((x / 2 + y / 2) % 2 == 0 ? 0.5 : -0.5) * strength);
  add_grain(canvas, strength, random);
}

/// One printed shape: disc, ring, bar, cross, triangle or L, rotated by `angle`.
void print_shape(Canvas& canvas, int kind, double cx, double cy, double radius, double angle, float grey) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const auto distance = [&](int px, int py) {
    const double dx = px - cx;
    const double dy = py - cy;
    const double x = c * dx + s * dy;
    const double y = -s * dx + c * dy;
    switch (kind) {
      case 0:
        return length(x, y) - 0.8 * radius;
      case 1:
        return std::abs(length(x, y) - 0.65 * radius) - 0.22 * radius;
      case 2:
        return rectangle_distance(x, y, 0.95 * radius, 0.3 * radius);
      case 3:
        return std::min(rectangle_distance(x, y, 0.9 * radius, 0.25 * radius),
                        rectangle_distance(x, y, 0.25 * radius, 0.9 * radius));
      case 4:  // intersection of three half planes
        return std::max(
            {y - 0.5 * radius, 0.866 * x - 0.5 * y - 0.5 * radius, -0.866 * x - 0.5 * y - 0.5 * radius});
      default:
        return std::min(rectangle_distance(x + 0.4 * radius, y, 0.25 * radius, 0.8 * radius),
                        rectangle_distance(x, y - 0.55 * radius, 0.65 * radius, 0.25 * radius));
    }
  };
  paint(canvas, box_around(cx, cy, 1.1 * radius), grey, distance);
}

/// Patches: each texel has the grey level of the nearest of a set of random centres.
void draw_patches(Canvas& canvas, int cell, double grey_low, double grey_high, Random& random) {
  struct Patch {
    double x, y;
    float grey;
  };
  const int columns = canvas.width() / cell + 1;
  const int rows = canvas.height() / cell + 1;
  std::vector<Patch> patches;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      patches.push_back({(column + random.uniform()) * cell, (row + random.uniform()) * cell,
                         static_cast<float>(random.uniform(grey_low, grey_high))});
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) {
      double nearest = std::numeric_limits<double>::max();
      for (int row = std::max(0, y / cell - 2); row < std::min(rows, y / cell + 3); ++row)
        for (int column = std::max(0, x / cell - 2); column < std::min(columns, x / cell + 3); ++column) {
          const Patch& patch = patches[static_cast<std::size_t>(row) * columns + column];
          const double d = (patch.x - x) * (patch.x - x) + (patch.y - y) * (patch.y - y);
          if (d >= nearest) continue;
          nearest = d;
          canvas.at(x, y) = patch.grey;
        }
    }
}

/// Shapes from large to small, mostly dark on light and light on dark, over patches of grey.
void draw_bold(Canvas& canvas, Random& random) {
  draw_patches(canvas, 150, 70, 175, random);
  constexpr struct {
    int count;
    double radius_low, radius_high;
  } kLayers[] = {{90, 40, 62}, {330, 18, 34}, {560, 10, 17}, {420, 6, 9}};
  for (const auto& layer : kLayers)
    for (int i = 0; i < layer.count; ++i) {
      const double radius = random.uniform(layer.radius_low, layer.radius_high);
      const double x = random.uniform(0, canvas.width());
      const double y = random.uniform(0, canvas.height());
      // Mostly in contrast to the grey below, so that few shapes are invisible.
      const int ground_x = std::clamp(static_cast<int>(x), 0, canvas.width() - 1);
      const int ground_y = std::clamp(static_cast<int>(y), 0, canvas.height() - 1);
      const bool light =
          canvas.at(ground_x, ground_y) < 120.f ? random.uniform() < 0.85 : random.uniform() < 0.15;
      const auto grey = static_cast<float>(light ? random.uniform(180, 240) : random.uniform(15, 65));
      print_shape(canvas, random.index(6), x, y, radius, random.uniform(0, 2 * std::numbers::pi), grey);
    }
}

/// A sum of smooth waves, quantised to three grey levels with edges a centimetre wide.
void draw_blobs(Canvas& canvas, Random& random) {
  struct Wave {
    double kx, ky, phase;
  };
  std::vector<Wave> waves;
  for (int i = 0; i < 14; ++i) {
    const double k = 2.0 * std::numbers::pi / random.uniform(90, 260);
    const double direction = random.uniform(0, 2 * std::numbers::pi);
    waves.push_back({k * std::cos(direction), k * std::sin(direction), random.uniform(0, 6.28)});
  }
  const auto step = [](double value, double edge) {
    return std::clamp((value - edge) / 0.5 + 0.5, 0.0, 1.0);
  };
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) {
      double sum = 0.0;
      for (const Wave& wave : waves) sum += std::sin(wave.kx * x + wave.ky * y + wave.phase);
      canvas.at(x, y) = static_cast<float>(60.0 + 60.0 * step(sum, -1.2) + 70.0 * step(sum, 1.6));
    }
}

/// Two seven-segment digits and a bar above them, in the middle of the back.
void draw_jersey(Canvas& canvas, Random& random) {
  constexpr double kBar = 14, kHalfWidth = 45, kHalfHeight = 50;  // a digit consists of two squares
  const auto bar = [&](double x, double y, double half_x, double half_y) {
    paint(canvas, box_around(x, y, std::max(half_x, half_y) + 4), 225.f,
          [&](int px, int py) { return rectangle_distance(px - x, py - y, half_x, half_y); });
  };
  constexpr int kSegments[10] = {0x77, 0x24, 0x5d, 0x6d, 0x2e, 0x6b, 0x7b, 0x25, 0x7f, 0x6f};
  const double middle = 0.5 * kShirtWidthTexels;
  bar(middle, 150, 130, 18);
  for (const double side : {-1.0, 1.0}) {
    const double x = middle + 75 * side;
    constexpr double kY = 340;
    const int lit = kSegments[2 + random.index(8)];
    if (lit & 0x01) bar(x, kY - 2 * kHalfHeight, kHalfWidth, kBar);
    if (lit & 0x02) bar(x - kHalfWidth, kY - kHalfHeight, kBar, kHalfHeight + kBar);
    if (lit & 0x04) bar(x + kHalfWidth, kY - kHalfHeight, kBar, kHalfHeight + kBar);
    if (lit & 0x08) bar(x, kY, kHalfWidth, kBar);
    if (lit & 0x10) bar(x - kHalfWidth, kY + kHalfHeight, kBar, kHalfHeight + kBar);
    if (lit & 0x20) bar(x + kHalfWidth, kY + kHalfHeight, kBar, kHalfHeight + kBar);
    if (lit & 0x40) bar(x, kY + 2 * kHalfHeight, kHalfWidth, kBar);
  }
}

void draw_dots(Canvas& canvas) {
  constexpr int kCell = 64;
  for (int y = kCell / 2; y < canvas.height(); y += kCell)
    for (int x = kCell / 2; x < canvas.width(); x += kCell)
      paint(canvas, box_around(x, y, 18), 225.f,
            [&](int px, int py) { return length(px - x, py - y) - 18.0; });
}

void draw_fine_check(Canvas& canvas) {
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x)
      canvas.at(x, y) = 70.f + ((x / 8) % 2 == 0 ? 70.f : 0.f) + ((y / 8) % 2 == 0 ? 70.f : 0.f);
}

void draw_stripes(Canvas& canvas) {
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) canvas.at(x, y) = (y / 32) % 2 == 0 ? 50.f : 200.f;
}

void draw_marks(Canvas& canvas) {
  for (int i = 0; i < kShirtMarks; ++i) {
    const ShirtMark mark = shirt_mark(i);
    paint(canvas, box_around(mark.s_texel, mark.t_texel, 12), 250.f,
          [&](int x, int y) { return length(x - mark.s_texel, y - mark.t_texel) - 12.0; });
  }
}

struct DesignName {
  const char* name;
  ShirtDesign design;
};
constexpr DesignName kDesignNames[] = {{"bold", ShirtDesign::Bold},
                                       {"mosaic", ShirtDesign::Mosaic},
                                       {"blobs", ShirtDesign::Blobs},
                                       {"shapes", ShirtDesign::Shapes},
                                       {"emblem", ShirtDesign::Emblem},
                                       {"photo", ShirtDesign::Photo},
                                       {"text", ShirtDesign::Text},
                                       {"jersey", ShirtDesign::Jersey},
                                       {"dotted", ShirtDesign::Dotted},
                                       {"striped", ShirtDesign::Striped},
                                       {"fine_check", ShirtDesign::FineCheck},
                                       {"plain", ShirtDesign::Plain},
                                       {"marked", ShirtDesign::Marked}};

/// Grey level of the cloth below the print.
float cloth_grey(ShirtDesign design, Random& random) {
  switch (design) {
    case ShirtDesign::Marked:
    case ShirtDesign::Jersey:
      return 60.f;
    case ShirtDesign::Shapes:
      return 215.f;
    case ShirtDesign::Emblem:
      return static_cast<float>(random.uniform(55, 85));
    case ShirtDesign::Photo:
      return 28.f;
    case ShirtDesign::Text:
      return random.uniform() < 0.5 ? 45.f : 205.f;
    default:
      return 120.f;
  }
}

}  // namespace

ShirtDesign shirt_design(const std::string& name) {
  std::string known;
  for (const auto& [design_name, design] : kDesignNames) {
    if (name == design_name) return design;
    known += (known.empty() ? "" : ", ") + std::string(design_name);
  }
  throw Error("'" + name + "' (expected a shirt design: " + known + ")");
}

ShirtMark shirt_mark(int index) {
  const int column = index % 3 - 1;
  const int row = index / 3;
  return {0.5 * kShirtWidthTexels + 100.0 * column, 140.0 + 110.0 * row};
}

Canvas draw_shirt(ShirtDesign design, std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(kShirtWidthTexels, kShirtHeightTexels, cloth_grey(design, random));
  switch (design) {
    case ShirtDesign::Bold:
      draw_bold(canvas, random);
      break;
    case ShirtDesign::Mosaic:
      draw_patches(canvas, 48, 15, 240, random);
      break;
    case ShirtDesign::Blobs:
      draw_blobs(canvas, random);
      break;
    case ShirtDesign::Jersey:
      draw_jersey(canvas, random);
      break;
    case ShirtDesign::Dotted:
      draw_dots(canvas);
      break;
    case ShirtDesign::Striped:
      draw_stripes(canvas);
      break;
    case ShirtDesign::FineCheck:
      draw_fine_check(canvas);
      break;
    case ShirtDesign::Shapes:
      draw_shapes(canvas, random);
      break;
    case ShirtDesign::Emblem:
      draw_emblem(canvas, random);
      break;
    case ShirtDesign::Photo:
      draw_photo(canvas, random);
      break;
    case ShirtDesign::Text:
      draw_text(canvas, random);
      break;
    case ShirtDesign::Plain:
      break;
    case ShirtDesign::Marked:
      draw_marks(canvas);
      return canvas;
  }
  weave(canvas, 3.0, random);
  return canvas;
}

}  // namespace heel::sim
