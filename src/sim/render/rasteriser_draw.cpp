// Drawing: the nearest face of every pixel, then its texture.
#include <algorithm>
#include <cmath>

#include "sim/render/rasteriser.h"

namespace heel::sim {
namespace {

constexpr int kRunPixels = 16;  ///< most pixels of a row that are shaded from one mip level
constexpr int kBandRows = 24;   ///< rows that a thread processes at a time

/// Bilinear look-up at 8-bit fixed-point texel coordinates; 8.16 fixed-point grey.
inline int bilinear(const Texture::Level& level, int s, int t) {
  const int x0 = (s >> 8) & level.width_mask;
  const int y0 = (t >> 8) & level.height_mask;
  const int x1 = (x0 + 1) & level.width_mask;
  const int y1 = (y0 + 1) & level.height_mask;
  const int fx = s & 255;
  const int fy = t & 255;
  const std::uint8_t* row0 = level.texels.data() + (static_cast<std::size_t>(y0) << level.width_shift);
  const std::uint8_t* row1 = level.texels.data() + (static_cast<std::size_t>(y1) << level.width_shift);
  const int top = (row0[x0] << 8) + (row0[x1] - row0[x0]) * fx;
  const int bottom = (row1[x0] << 8) + (row1[x1] - row1[x0]) * fx;
  return (top << 8) + (bottom - top) * fy;
}

}  // namespace

Rasteriser::RayForm Rasteriser::RowwiseForm::at(float rows_below_middle) const {
  return {middle[0] + rows_below_middle * per_row[0], middle[1] + rows_below_middle * per_row[1],
          middle[2] + rows_below_middle * per_row[2]};
}

int Rasteriser::body(int x_px, int y_px) const {
  const std::int32_t id = face_id_[index(x_px, y_px)];
  return id < 0 ? -1 : faces_[static_cast<std::size_t>(id)].surface.body;
}

template <FaceShape kShape>
void Rasteriser::find_pixels(const Face& face, std::int32_t id, int y_begin, int y_end) {
  const int count = face.window.x1 - face.window.x0;
  for (int y = y_begin; y < y_end; ++y) {
    const float dy = rows_below_middle(y);
    const RayForm fu = face.u.at(dy), fv = face.v.at(dy), fw = face.w.at(dy);
    const std::size_t first = index(face.window.x0, y);
    const float* __restrict rx = rays_.x.data() + first;
    const float* __restrict ry = rays_.y.data() + first;
    float* __restrict nearest = inverse_depth_.data() + first;
    std::int32_t* __restrict ids = face_id_.data() + first;
    for (int i = 0; i < count; ++i) {
      const float u = fu[0] * rx[i] + fu[1] * ry[i] + fu[2];
      const float v = fv[0] * rx[i] + fv[1] * ry[i] + fv[2];
      const float w = fw[0] * rx[i] + fw[1] * ry[i] + fw[2];
      // Bitwise and, because a branch would prevent vectorisation.
      bool inside = (u >= 0.f) & (v >= 0.f) & (w > nearest[i]);
      if constexpr (kShape == FaceShape::Triangle)
        inside = inside & (u + v <= w);
      else
        inside = inside & (u <= w) & (v <= w);
      nearest[i] = inside ? w : nearest[i];
      ids[i] = inside ? id : ids[i];
    }
  }
}

void Rasteriser::draw(float background, std::vector<float>& radiance) {
  radiance.resize(rays_.x.size());
  workers_.parallel_for(height_, kBandRows, [&](int y_begin, int y_end) {
    const auto first = static_cast<std::ptrdiff_t>(index(0, y_begin));
    const auto pixels = static_cast<std::ptrdiff_t>(index(0, y_end)) - first;
    std::fill_n(inverse_depth_.begin() + first, pixels, 0.f);
    std::fill_n(face_id_.begin() + first, pixels, -1);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const Face& face = faces_[i];
      const int from = std::max(face.window.y0, y_begin);
      const int to = std::min(face.window.y1, y_end);
      if (from >= to) continue;
      if (face.shape == FaceShape::Triangle)
        find_pixels<FaceShape::Triangle>(face, static_cast<std::int32_t>(i), from, to);
      else
        find_pixels<FaceShape::Parallelogram>(face, static_cast<std::int32_t>(i), from, to);
    }
    for (int y = y_begin; y < y_end; ++y) shade_row(y, background, radiance.data() + index(0, y));
  });
}

void Rasteriser::shade_row(int y, float background, float* out) const {
  int x = 0;
  while (x < width_) {
    const std::int32_t id = face_id_[index(x, y)];
    int end = x + 1;
    while (end < width_ && end - x < kRunPixels && face_id_[index(end, y)] == id) ++end;
    if (id < 0)
      std::fill_n(out + x, end - x, background);
    else
      shade_run(faces_[static_cast<std::size_t>(id)], x, y, end - x, out + x);
    x = end;
  }
}

void Rasteriser::shade_run(const Face& face, int x, int y, int count, float* out) const {
  const std::size_t first = index(x, y);
  const float* rx = rays_.x.data() + first;
  const float* ry = rays_.y.data() + first;
  const float dy = rows_below_middle(y);
  const RayForm fw = face.w.at(dy), fs = face.s.at(dy), ft = face.t.at(dy), fl = face.light.at(dy);
  int s[kRunPixels];
  int t[kRunPixels];
  float light[kRunPixels];
  for (int i = 0; i < count; ++i) {
    const float z = 1.f / (fw[0] * rx[i] + fw[1] * ry[i] + fw[2]);
    const float z256 = z * 256.f;
    s[i] = static_cast<int>((fs[0] * rx[i] + fs[1] * ry[i] + fs[2]) * z256);
    t[i] = static_cast<int>((ft[0] * rx[i] + ft[1] * ry[i] + ft[2]) * z256);
    light[i] = (fl[0] * rx[i] + fl[1] * ry[i] + fl[2]) * z * (1.f / 65536.f);
  }
  const float w = inverse_depth_[first + static_cast<std::size_t>(count / 2)];
  const float lod = std::max(0.f, 0.5f * std::log2(face.footprint2 / (w * w * w)));
  const int last = face.surface.texture->levels() - 1;
  const int fine = std::min(static_cast<int>(lod), last);
  const int coarse = std::min(fine + 1, last);
  const int blend = static_cast<int>((lod - static_cast<float>(fine)) * 256.f);
  const Texture::Level& a = face.surface.texture->level(fine);
  const Texture::Level& b = face.surface.texture->level(coarse);
  // Texel centres of level 0 are at whole numbers; centre k of level l is at (k + ½) 2^l − ½ of level 0.
  if (blend < 16 || fine == coarse) {
    for (int i = 0; i < count; ++i)
      out[i] = light[i] *
               static_cast<float>(bilinear(a, ((s[i] + 128) >> fine) - 128, ((t[i] + 128) >> fine) - 128));
    return;
  }
  const float share = static_cast<float>(std::min(blend, 256)) * (1.f / 256.f);
  for (int i = 0; i < count; ++i) {
    const auto g0 =
        static_cast<float>(bilinear(a, ((s[i] + 128) >> fine) - 128, ((t[i] + 128) >> fine) - 128));
    const auto g1 =
        static_cast<float>(bilinear(b, ((s[i] + 128) >> coarse) - 128, ((t[i] + 128) >> coarse) - 128));
    out[i] = light[i] * (g0 + (g1 - g0) * share);
  }
}

}  // namespace heel::sim
