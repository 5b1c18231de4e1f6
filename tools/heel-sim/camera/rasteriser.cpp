#include "heel-sim/camera/rasteriser.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace heel::sim {
namespace {

constexpr float kNearM = 0.05f;     ///< nothing nearer is drawn
constexpr int kWindowMarginPx = 2;  ///< edges bulge a little between projected points under distortion
constexpr int kEdgeSteps = 6;       ///< projected points along each edge of the search window's outline
constexpr int kRun = 16;            ///< pixels sharing one mip level

/// Clips a polygon to a·p ≥ 0, (a as a linear form plus constant).
void clip(std::vector<Eigen::Vector3f>& polygon, const Eigen::Vector3f& normal, float offset) {
  std::vector<Eigen::Vector3f> out;
  out.reserve(polygon.size() + 1);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3f& a = polygon[i];
    const Eigen::Vector3f& b = polygon[(i + 1) % polygon.size()];
    const float da = normal.dot(a) + offset;
    const float db = normal.dot(b) + offset;
    if (da >= 0.f) out.push_back(a);
    if ((da >= 0.f) != (db >= 0.f)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  polygon.swap(out);
}

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

Rasteriser::Rasteriser(const RayTable& rays)
    : rays_(rays),
      width_(rays.camera.width_px),
      height_(rays.camera.height_px),
      inverse_depth_(rays.x.size(), 0.f),
      face_id_(rays.x.size(), -1) {}

void Rasteriser::clear() {
  std::fill(inverse_depth_.begin(), inverse_depth_.end(), 0.f);
  std::fill(face_id_.begin(), face_id_.end(), -1);
  faces_.clear();
}

int Rasteriser::body(int x_px, int y_px) const {
  const std::int32_t id = face_id_[index(x_px, y_px)];
  return id < 0 ? -1 : faces_[static_cast<std::size_t>(id)].body;
}

Rasteriser::Window Rasteriser::window_of(const Face& face) const {
  const Eigen::Vector3f& p0 = face.corners[0].position_m;
  const Eigen::Vector3f& p1 = face.corners[1].position_m;
  const Eigen::Vector3f& p2 = face.corners[2].position_m;
  std::vector<Eigen::Vector3f> polygon{p0, p1, p2};
  if (face.shape == FaceShape::Parallelogram) polygon = {p0, p1, p1 + p2 - p0, p2};
  // Distortion is only meaningful inside the picture: clip to the pyramid of rays before projecting.
  const float ax = rays_.x_max + 0.01f;
  const float ay = rays_.y_max + 0.01f;
  clip(polygon, {0, 0, 1}, -kNearM);
  clip(polygon, {1, 0, ax}, 0.f);
  clip(polygon, {-1, 0, ax}, 0.f);
  clip(polygon, {0, 1, ay}, 0.f);
  clip(polygon, {0, -1, ay}, 0.f);
  if (polygon.size() < 3) return {};
  const CameraModel& camera = rays_.camera;
  double x_min = 1e9, x_max = -1e9, y_min = 1e9, y_max = -1e9;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3f& a = polygon[i];
    const Eigen::Vector3f& b = polygon[(i + 1) % polygon.size()];
    const float length_px =
        (a.head<2>() / a.z() - b.head<2>() / b.z()).norm() * static_cast<float>(camera.fx);
    const int steps = length_px > 32.f ? kEdgeSteps : 1;
    for (int k = 0; k < steps; ++k) {
      const Eigen::Vector3f p = a + (b - a) * (static_cast<float>(k) / static_cast<float>(steps));
      const Eigen::Vector2d ideal(camera.fx * static_cast<double>(p.x() / p.z()) + camera.cx,
                                  camera.fy * static_cast<double>(p.y() / p.z()) + camera.cy);
      const Eigen::Vector2d px = camera.distort_px(ideal);
      x_min = std::min(x_min, px.x());
      x_max = std::max(x_max, px.x());
      y_min = std::min(y_min, px.y());
      y_max = std::max(y_max, px.y());
    }
  }
  // A long edge bulges between the sampled points by a small share of its own extent.
  const double margin = kWindowMarginPx + 0.01 * std::max(x_max - x_min, y_max - y_min);
  Window window;
  window.x0 = std::max(0, static_cast<int>(std::floor(x_min - margin)));
  window.y0 = std::max(0, static_cast<int>(std::floor(y_min - margin)));
  window.x1 = std::min(width_, static_cast<int>(std::ceil(x_max + margin)) + 1);
  window.y1 = std::min(height_, static_cast<int>(std::ceil(y_max + margin)) + 1);
  return window;
}

void Rasteriser::draw(const Face& face) {
  const Eigen::Vector3f& p0 = face.corners[0].position_m;
  const Eigen::Vector3f e1 = face.corners[1].position_m - p0;
  const Eigen::Vector3f e2 = face.corners[2].position_m - p0;
  const Eigen::Vector3f normal = e1.cross(e2);
  const float area = normal.norm();
  const float towards = -normal.dot(p0);  // > 0: the camera is on the outside
  if (area <= 0.f || std::abs(towards) < 1e-9f || (towards < 0.f && !face.two_sided)) return;
  const Window window = window_of(face);
  if (window.empty()) return;

  Eigen::Matrix3d M;
  M << e1.cast<double>(), e2.cast<double>(), p0.cast<double>();
  const Eigen::Matrix3d inverse = M.inverse();
  const auto row = [](const Eigen::RowVector3d& r) {
    return Row{static_cast<float>(r.x()), static_cast<float>(r.y()), static_cast<float>(r.z())};
  };
  const auto attribute = [&](float Corner::*member) {
    const double a0 = face.corners[0].*member;
    return row(inverse.row(2) * a0 + inverse.row(0) * (face.corners[1].*member - a0) +
               inverse.row(1) * (face.corners[2].*member - a0));
  };
  Prepared prepared;
  prepared.u = row(inverse.row(0));
  prepared.v = row(inverse.row(1));
  prepared.w = row(inverse.row(2));
  prepared.s = attribute(&Corner::s_texel);
  prepared.t = attribute(&Corner::t_texel);
  prepared.light = attribute(&Corner::light);
  // A pixel at depth z spans z/f metres across and z/(f cos θ) along the slope; cos θ = distance of the plane
  // / z. The geometric mean of both sides is the footprint: neither too sharp along nor too soft across.
  const float plane_distance_m = std::abs(towards) / area;
  const float scale = face.texels_per_m / static_cast<float>(rays_.camera.fx);
  prepared.footprint2 = scale * scale / std::max(plane_distance_m, 1e-3f);
  prepared.texture = face.texture;
  prepared.body = face.body;
  const auto id = static_cast<std::int32_t>(faces_.size());
  faces_.push_back(prepared);
  if (face.shape == FaceShape::Triangle)
    fill<FaceShape::Triangle>(prepared, id, window);
  else
    fill<FaceShape::Parallelogram>(prepared, id, window);
}

template <FaceShape kShape>
void Rasteriser::fill(const Prepared& face, std::int32_t id, const Window& window) {
  for (int y = window.y0; y < window.y1; ++y) {
    const std::size_t first = index(window.x0, y);
    const int count = window.x1 - window.x0;
    const float* __restrict rx = rays_.x.data() + first;
    const float* __restrict ry = rays_.y.data() + first;
    float* __restrict nearest = inverse_depth_.data() + first;
    std::int32_t* __restrict ids = face_id_.data() + first;
    for (int i = 0; i < count; ++i) {
      const float u = face.u[0] * rx[i] + face.u[1] * ry[i] + face.u[2];
      const float v = face.v[0] * rx[i] + face.v[1] * ry[i] + face.v[2];
      const float w = face.w[0] * rx[i] + face.w[1] * ry[i] + face.w[2];
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

void Rasteriser::shade_run(const Prepared& face, std::size_t first, int count, float* out) const {
  const float* rx = rays_.x.data() + first;
  const float* ry = rays_.y.data() + first;
  int s[kRun];
  int t[kRun];
  float light[kRun];
  for (int i = 0; i < count; ++i) {
    const float z = 1.f / (face.w[0] * rx[i] + face.w[1] * ry[i] + face.w[2]);
    const float z256 = z * 256.f;
    s[i] = static_cast<int>((face.s[0] * rx[i] + face.s[1] * ry[i] + face.s[2]) * z256);
    t[i] = static_cast<int>((face.t[0] * rx[i] + face.t[1] * ry[i] + face.t[2]) * z256);
    light[i] = (face.light[0] * rx[i] + face.light[1] * ry[i] + face.light[2]) * z * (1.f / 65536.f);
  }
  const float w = inverse_depth_[first + static_cast<std::size_t>(count / 2)];
  const float lod = std::max(0.f, 0.5f * std::log2(face.footprint2 / (w * w * w)));
  const int last = face.texture->levels() - 1;
  const int fine = std::min(static_cast<int>(lod), last);
  const int coarse = std::min(fine + 1, last);
  const int blend = static_cast<int>((lod - static_cast<float>(fine)) * 256.f);
  const Texture::Level& a = face.texture->level(fine);
  const Texture::Level& b = face.texture->level(coarse);
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

void Rasteriser::shade(float background, std::vector<float>& radiance) const {
  radiance.resize(rays_.x.size());
  for (int y = 0; y < height_; ++y) {
    int x = 0;
    while (x < width_) {
      const std::size_t first = index(x, y);
      const std::int32_t id = face_id_[first];
      int end = x + 1;
      while (end < width_ && end - x < kRun && face_id_[index(end, y)] == id) ++end;
      if (id < 0)
        std::fill_n(radiance.begin() + static_cast<std::ptrdiff_t>(first), end - x, background);
      else
        shade_run(faces_[static_cast<std::size_t>(id)], first, end - x, radiance.data() + first);
      x = end;
    }
  }
}

}  // namespace heel::sim
