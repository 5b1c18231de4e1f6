// Adding faces: which are visible, where in the picture, and their linear forms of the ray.
#include "sim/render/rasteriser.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/render/face_window.h"

namespace heel::sim {
namespace {

constexpr double kWindowMargin_px = 2.0;      ///< distortion bends long edges between projected points
constexpr double kMeshWindowMargin_px = 0.1;  ///< and short ones hardly

/// M⁻¹ for M = [e1, e2, p0]; its rows are the forms of u/z, v/z and 1/z.
Eigen::Matrix3d inverse_of(const Eigen::Vector3d& e1, const Eigen::Vector3d& e2, const Eigen::Vector3d& p0) {
  Eigen::Matrix3d rows;
  const Eigen::Vector3d u = e2.cross(p0);
  rows << u.transpose(), p0.cross(e1).transpose(), e1.cross(e2).transpose();
  return rows / e1.dot(u);
}

/// The corner's position at a share of the readout: −½ at the first row, ½ at the last.
Eigen::Vector3f position_at(const Corner& corner, float share) {
  return corner.position_m + share * corner.shift_m;
}

}  // namespace

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
    const Eigen::Vector3f p0 = position_at(corners[0], share);
    const Eigen::Vector3f p1 = position_at(corners[1], share);
    const Eigen::Vector3f p2 = position_at(corners[2], share);
    // Most faces are completely beside or behind the view.
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
  // Distortion moves the middle of a long edge by a small share of its length.
  const double margin =
      kWindowMargin_px + 0.01 * std::max(bounds.x_high - bounds.x_low, bounds.y_high - bounds.y_low);
  return clamped(bounds.x_low - margin, bounds.x_high + margin, bounds.y_low - margin,
                 bounds.y_high + margin);
}

void Rasteriser::add(FaceShape shape, const std::array<Corner, 3>& corners, const Surface& surface) {
  if (!faces_camera(corners)) return;
  const Window window = window_of(shape, corners);
  if (!window.empty()) add_in_window(shape, corners, surface, window);
}

Rasteriser::CornerPixels Rasteriser::pixels_of(const Corner& corner) const {
  CornerPixels out;
  PixelBounds bounds;
  const bool moves = !corner.shift_m.isZero(0.f);
  for (const float share : {-0.5f, 0.5f}) {
    const Eigen::Vector3f p = position_at(corner, moves ? share : 0.f);
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
                          const Surface& surface) {
  corner_pixels_.clear();
  for (const Corner& corner : corners) corner_pixels_.push_back(pixels_of(corner));
  for (const auto& [i, j, k] : triangles) {
    const std::array<std::size_t, 3> at{static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                                        static_cast<std::size_t>(k)};
    const std::array<Corner, 3> face{corners[at[0]], corners[at[1]], corners[at[2]]};
    if (!faces_camera(face)) continue;
    const CornerPixels& a = corner_pixels_[at[0]];
    const CornerPixels& b = corner_pixels_[at[1]];
    const CornerPixels& c = corner_pixels_[at[2]];
    Window window;
    if (a.inside && b.inside && c.inside)
      window = clamped(std::min({a.x_low, b.x_low, c.x_low}) - kMeshWindowMargin_px,
                       std::max({a.x_high, b.x_high, c.x_high}) + kMeshWindowMargin_px,
                       std::min({a.y_low, b.y_low, c.y_low}) - kMeshWindowMargin_px,
                       std::max({a.y_high, b.y_high, c.y_high}) + kMeshWindowMargin_px);
    else
      window = window_of(FaceShape::Triangle, face);
    if (!window.empty()) add_in_window(FaceShape::Triangle, face, surface, window);
  }
}

void Rasteriser::add_in_window(FaceShape shape, const std::array<Corner, 3>& corners, const Surface& surface,
                               const Window& window) {
  const auto rows_at = [&](float share) {
    const Eigen::Vector3d p0 = position_at(corners[0], share).cast<double>();
    return inverse_of(position_at(corners[1], share).cast<double>() - p0,
                      position_at(corners[2], share).cast<double>() - p0, p0);
  };
  const Eigen::Matrix3d middle = rows_at(0.f);
  if (!middle.allFinite()) return;  // the face contains the camera's centre
  bool moves = false;
  for (const Corner& corner : corners) moves |= !corner.shift_m.isZero(0.f);
  Eigen::Matrix3d per_row = Eigen::Matrix3d::Zero();
  if (moves) per_row = (rows_at(0.5f) - rows_at(-0.5f)) / (height_ - 1);
  const auto as_ray_form = [](const Eigen::RowVector3d& r) {
    return RayForm{static_cast<float>(r.x()), static_cast<float>(r.y()), static_cast<float>(r.z())};
  };
  const auto form = [&](double a0, double a1, double a2) {
    const Eigen::RowVector3d weights(a1 - a0, a2 - a0, a0);
    return RowwiseForm{as_ray_form(weights * middle), as_ray_form(weights * per_row)};
  };
  const auto attribute = [&](float Corner::*member) {
    return form(corners[0].*member, corners[1].*member, corners[2].*member);
  };
  Face face;
  face.u = {as_ray_form(middle.row(0)), as_ray_form(per_row.row(0))};
  face.v = {as_ray_form(middle.row(1)), as_ray_form(per_row.row(1))};
  face.w = {as_ray_form(middle.row(2)), as_ray_form(per_row.row(2))};
  face.s = attribute(&Corner::s_texel);
  face.t = attribute(&Corner::t_texel);
  face.light = attribute(&Corner::light);
  // A pixel at depth z covers z/f metres across and z/(f cos θ) along the slope; cos θ = distance of the
  // plane / z. The footprint is the geometric mean of both: neither too sharp along nor too soft across. The
  // plane's distance is 1 / |gradient of 1/z|.
  const float scale = surface.texels_per_m / static_cast<float>(rays_.camera.fx);
  face.footprint2 = scale * scale * static_cast<float>(std::min(middle.row(2).norm(), 1e3));
  face.shape = shape;
  face.window = window;
  face.surface = surface;
  faces_.push_back(face);
}

}  // namespace heel::sim
