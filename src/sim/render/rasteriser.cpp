#include "sim/render/rasteriser.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/render/face_window.h"

namespace heel::sim {
namespace {

constexpr double kWindowMargin_px = 2.0;      ///< long edges bulge a little between projected points
constexpr double kMeshWindowMargin_px = 0.1;  ///< short ones do not
constexpr int kRun = 16;                      ///< pixels sharing one mip level
constexpr int kBandRows = 24;                 ///< rows a thread takes at a time

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

/// Rows of M⁻¹ for M = [e1, e2, p0]: the forms of u/z, v/z and 1/z.
Eigen::Matrix3d inverse_of(const Eigen::Vector3d& e1, const Eigen::Vector3d& e2, const Eigen::Vector3d& p0) {
  Eigen::Matrix3d rows;
  const Eigen::Vector3d u = e2.cross(p0);
  rows << u.transpose(), p0.cross(e1).transpose(), e1.cross(e2).transpose();
  return rows / e1.dot(u);
}

/// Position at a share of the readout, −½ the first row, ½ the last.
Eigen::Vector3f at_share(const Corner& corner, float share) {
  return corner.position_m + share * corner.shift_m;
}

}  // namespace

Rasteriser::Row Rasteriser::Form::at(float rows_below_middle) const {
  return {middle[0] + rows_below_middle * per_row[0], middle[1] + rows_below_middle * per_row[1],
          middle[2] + rows_below_middle * per_row[2]};
}

Rasteriser::Rasteriser(const RayTable& rays, ThreadPool& workers)
    : rays_(rays),
      workers_(workers),
      width_(rays.camera.width_px),
      height_(rays.camera.height_px),
      inverse_depth_(rays.x.size(), 0.f),
      face_id_(rays.x.size(), -1) {}

void Rasteriser::clear() {
  faces_.clear();
}

int Rasteriser::body(int x_px, int y_px) const {
  const std::int32_t id = face_id_[index(x_px, y_px)];
  return id < 0 ? -1 : faces_[static_cast<std::size_t>(id)].look.body;
}

bool Rasteriser::faces_camera(const std::array<Corner, 3>& corners) const {
  const Eigen::Vector3f& p0 = corners[0].position_m;
  const Eigen::Vector3f normal = (corners[1].position_m - p0).cross(corners[2].position_m - p0);
  return -normal.dot(p0) > 1e-9f;
}

Rasteriser::Window Rasteriser::clamped(double x_low, double x_high, double y_low, double y_high) const {
  return {std::max(0, static_cast<int>(std::ceil(x_low))), std::max(0, static_cast<int>(std::ceil(y_low))),
          std::min(width_, static_cast<int>(std::floor(x_high)) + 1),
          std::min(height_, static_cast<int>(std::floor(y_high)) + 1)};
}

Rasteriser::Window Rasteriser::window_of(FaceShape shape, const std::array<Corner, 3>& corners) const {
  bool moves = false;
  for (const Corner& corner : corners) moves |= !corner.shift_m.isZero(0.f);
  PixelBounds bounds;
  for (const float share : {-0.5f, 0.5f}) {
    const Eigen::Vector3f p0 = at_share(corners[0], share);
    const Eigen::Vector3f p1 = at_share(corners[1], share);
    const Eigen::Vector3f p2 = at_share(corners[2], share);
    // Most faces lie wholly beside or behind the view.
    const std::array<Eigen::Vector3f, 4> all{p0, p1, p1 + p2 - p0, p2};
    const auto all_beyond = [&](const Eigen::Vector3f& normal) {
      return std::all_of(all.begin(), all.end(),
                         [&](const Eigen::Vector3f& p) { return normal.dot(p) < 0.f; });
    };
    if (all_beyond({0.f, 0.f, 1.f}) || all_beyond({1.f, 0.f, rays_.x_max + 0.01f}) ||
        all_beyond({-1.f, 0.f, rays_.x_max + 0.01f}) || all_beyond({0.f, 1.f, rays_.y_max + 0.01f}) ||
        all_beyond({0.f, -1.f, rays_.y_max + 0.01f}))
      continue;
    if (shape == FaceShape::Parallelogram)
      add_polygon(rays_, {p0, p1, p1 + p2 - p0, p2}, bounds);
    else
      add_polygon(rays_, {p0, p1, p2}, bounds);
    if (!moves) break;
  }
  if (bounds.empty()) return {};
  // A long edge bulges between the sampled points by a small share of its own extent.
  const double margin =
      kWindowMargin_px + 0.01 * std::max(bounds.x_high - bounds.x_low, bounds.y_high - bounds.y_low);
  return clamped(bounds.x_low - margin, bounds.x_high + margin, bounds.y_low - margin,
                 bounds.y_high + margin);
}

void Rasteriser::add(FaceShape shape, const std::array<Corner, 3>& corners, const Look& look) {
  if (!faces_camera(corners)) return;
  const Window window = window_of(shape, corners);
  if (!window.empty()) take(shape, corners, look, window);
}

Rasteriser::Seen Rasteriser::seen(const Corner& corner) const {
  Seen out;
  PixelBounds bounds;
  const bool moves = !corner.shift_m.isZero(0.f);
  for (const float share : {-0.5f, 0.5f}) {
    const Eigen::Vector3f p = at_share(corner, moves ? share : 0.f);
    if (p.z() < kNear_m || std::abs(p.x()) > rays_.x_max * p.z() || std::abs(p.y()) > rays_.y_max * p.z())
      return out;
    bounds.add(distorted_px(rays_.camera, p));
    if (!moves) break;
  }
  out.inside = true;
  out.x_low = static_cast<float>(bounds.x_low);
  out.x_high = static_cast<float>(bounds.x_high);
  out.y_low = static_cast<float>(bounds.y_low);
  out.y_high = static_cast<float>(bounds.y_high);
  return out;
}

void Rasteriser::add_mesh(std::span<const Corner> corners, std::span<const std::array<int, 3>> triangles,
                          const Look& look) {
  seen_.clear();
  for (const Corner& corner : corners) seen_.push_back(seen(corner));
  for (const auto& [i, j, k] : triangles) {
    const std::array<std::size_t, 3> at{static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                                        static_cast<std::size_t>(k)};
    const std::array<Corner, 3> face{corners[at[0]], corners[at[1]], corners[at[2]]};
    if (!faces_camera(face)) continue;
    const Seen& a = seen_[at[0]];
    const Seen& b = seen_[at[1]];
    const Seen& c = seen_[at[2]];
    Window window;
    if (a.inside && b.inside && c.inside)
      window = clamped(std::min({a.x_low, b.x_low, c.x_low}) - kMeshWindowMargin_px,
                       std::max({a.x_high, b.x_high, c.x_high}) + kMeshWindowMargin_px,
                       std::min({a.y_low, b.y_low, c.y_low}) - kMeshWindowMargin_px,
                       std::max({a.y_high, b.y_high, c.y_high}) + kMeshWindowMargin_px);
    else
      window = window_of(FaceShape::Triangle, face);
    if (!window.empty()) take(FaceShape::Triangle, face, look, window);
  }
}

void Rasteriser::take(FaceShape shape, const std::array<Corner, 3>& corners, const Look& look,
                      const Window& window) {
  const auto rows_at = [&](float share) {
    const Eigen::Vector3d p0 = at_share(corners[0], share).cast<double>();
    return inverse_of(at_share(corners[1], share).cast<double>() - p0,
                      at_share(corners[2], share).cast<double>() - p0, p0);
  };
  const Eigen::Matrix3d middle = rows_at(0.f);
  if (!middle.allFinite()) return;  // seen edge on
  bool moves = false;
  for (const Corner& corner : corners) moves |= !corner.shift_m.isZero(0.f);
  Eigen::Matrix3d per_row = Eigen::Matrix3d::Zero();
  if (moves) per_row = (rows_at(0.5f) - rows_at(-0.5f)) / (height_ - 1);
  const auto as_row = [](const Eigen::RowVector3d& r) {
    return Row{static_cast<float>(r.x()), static_cast<float>(r.y()), static_cast<float>(r.z())};
  };
  const auto form = [&](double a0, double a1, double a2) {
    const Eigen::RowVector3d weights(a1 - a0, a2 - a0, a0);
    return Form{as_row(weights * middle), as_row(weights * per_row)};
  };
  const auto attribute = [&](float Corner::*member) {
    return form(corners[0].*member, corners[1].*member, corners[2].*member);
  };
  Face face;
  face.u = {as_row(middle.row(0)), as_row(per_row.row(0))};
  face.v = {as_row(middle.row(1)), as_row(per_row.row(1))};
  face.w = {as_row(middle.row(2)), as_row(per_row.row(2))};
  face.s = attribute(&Corner::s_texel);
  face.t = attribute(&Corner::t_texel);
  face.light = attribute(&Corner::light);
  // A pixel at depth z spans z/f metres across and z/(f cos θ) along the slope; cos θ = distance of the plane
  // / z. The geometric mean of both sides is the footprint: neither too sharp along nor too soft across. The
  // plane's distance is 1 / |the gradient of 1/z|.
  const float scale = look.texels_per_m / static_cast<float>(rays_.camera.fx);
  face.footprint2 = scale * scale * static_cast<float>(std::min(middle.row(2).norm(), 1e3));
  face.shape = shape;
  face.window = window;
  face.look = look;
  faces_.push_back(face);
}

template <FaceShape kShape>
void Rasteriser::fill(const Face& face, std::int32_t id, int y_begin, int y_end) {
  const int count = face.window.x1 - face.window.x0;
  for (int y = y_begin; y < y_end; ++y) {
    const float dy = rows_below_middle(y);
    const Row fu = face.u.at(dy), fv = face.v.at(dy), fw = face.w.at(dy);
    const std::size_t first = index(face.window.x0, y);
    const float* __restrict rx = rays_.x.data() + first;
    const float* __restrict ry = rays_.y.data() + first;
    float* __restrict nearest = inverse_depth_.data() + first;
    std::int32_t* __restrict ids = face_id_.data() + first;
    for (int i = 0; i < count; ++i) {
      const float u = fu[0] * rx[i] + fu[1] * ry[i] + fu[2];
      const float v = fv[0] * rx[i] + fv[1] * ry[i] + fv[2];
      const float w = fw[0] * rx[i] + fw[1] * ry[i] + fw[2];
      // Bitwise and: a branch here would keep the loop from being vectorised.
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
        fill<FaceShape::Triangle>(face, static_cast<std::int32_t>(i), from, to);
      else
        fill<FaceShape::Parallelogram>(face, static_cast<std::int32_t>(i), from, to);
    }
    for (int y = y_begin; y < y_end; ++y) shade_row(y, background, radiance.data() + index(0, y));
  });
}

void Rasteriser::shade_row(int y, float background, float* out) const {
  int x = 0;
  while (x < width_) {
    const std::int32_t id = face_id_[index(x, y)];
    int end = x + 1;
    while (end < width_ && end - x < kRun && face_id_[index(end, y)] == id) ++end;
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
  const Row fw = face.w.at(dy), fs = face.s.at(dy), ft = face.t.at(dy), fl = face.light.at(dy);
  int s[kRun];
  int t[kRun];
  float light[kRun];
  for (int i = 0; i < count; ++i) {
    const float z = 1.f / (fw[0] * rx[i] + fw[1] * ry[i] + fw[2]);
    const float z256 = z * 256.f;
    s[i] = static_cast<int>((fs[0] * rx[i] + fs[1] * ry[i] + fs[2]) * z256);
    t[i] = static_cast<int>((ft[0] * rx[i] + ft[1] * ry[i] + ft[2]) * z256);
    light[i] = (fl[0] * rx[i] + fl[1] * ry[i] + fl[2]) * z * (1.f / 65536.f);
  }
  const float w = inverse_depth_[first + static_cast<std::size_t>(count / 2)];
  const float lod = std::max(0.f, 0.5f * std::log2(face.footprint2 / (w * w * w)));
  const int last = face.look.texture->levels() - 1;
  const int fine = std::min(static_cast<int>(lod), last);
  const int coarse = std::min(fine + 1, last);
  const int blend = static_cast<int>((lod - static_cast<float>(fine)) * 256.f);
  const Texture::Level& a = face.look.texture->level(fine);
  const Texture::Level& b = face.look.texture->level(coarse);
  // Level 0 texel centres lie at whole numbers; level l's centre k lies at (k + ½) 2^l − ½ of level 0.
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
