#include "vision/reach/back_picture.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace heel {
namespace {

constexpr int kBackCells = 48;          // of the back, to each side
constexpr double kDrawnPart = 1.12;     // of the region's half size: cloth just outside of it is drawn, too
constexpr double kNearestDrawn = 0.05;  // in units of d: nearer than this nothing is drawn
constexpr int kMinSamples = 2, kMaxSamples = 4;  // of a pixel, in a row

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

double ClothFolds::at(const Eigen::Vector3d& ray) const {
  double sum = 0.0;
  for (const Wave& wave : waves)
    sum += wave.height * std::cos(wave.per_ray.dot(ray.head<2>()) + wave.phase_rad);
  return sum;
}

BackPicture::BackPicture(const ShirtTemplate& shirt, const BackSurface& surface, const CameraModel& camera)
    : surface_(surface),
      reference_camera_(shirt.camera),
      camera_(camera),
      reference_(shirt.grey, shirt.camera.width_px, shirt.camera.height_px) {}

void BackPicture::draw(const FrontalMotion& motion, const ClothFolds& folds, std::vector<float>& frame) {
  project(motion, folds);
  frame_samples(motion);
  const auto vertex = [&](int i, int j) -> const Vertex& {
    return vertices_[static_cast<std::size_t>(j * (kBackCells + 1) + i)];
  };
  for (int j = 0; j < kBackCells; ++j) {
    for (int i = 0; i < kBackCells; ++i) {
      draw_triangle(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      draw_triangle(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
  blend(frame);
}

void BackPicture::project(const FrontalMotion& motion, const ClothFolds& folds) {
  const Eigen::Matrix3d K_ref = reference_camera_.K(), K_cur = camera_.K();
  vertices_.clear();
  for (int j = 0; j <= kBackCells; ++j) {
    for (int i = 0; i <= kBackCells; ++i) {
      const Eigen::Vector3d ray(
          surface_.axis_x + kDrawnPart * (2.0 * i / kBackCells - 1.0) * surface_.half_size.x(),
          surface_.axis_y + kDrawnPart * (2.0 * j / kBackCells - 1.0) * surface_.half_size.y(), 1.0);
      const Eigen::Vector3d X_ref = surface_.point(ray) + folds.at(ray) * Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d X_cur = motion.R_cur_from_ref * X_ref + motion.t_over_d;
      Vertex vertex;
      vertex.depth = X_cur.z();
      vertex.ref_px = reference_camera_.distort_px((K_ref * ray).hnormalized());
      if (vertex.depth > kNearestDrawn) vertex.px = camera_.distort_px((K_cur * X_cur).hnormalized());
      vertices_.push_back(vertex);
    }
  }
}

/// Takes the memory for the samples: so many to a pixel that they are as dense as the template's pixels.
void BackPicture::frame_samples(const FrontalMotion& motion) {
  Eigen::AlignedBox2d box;
  for (const Vertex& vertex : vertices_)
    if (vertex.depth > kNearestDrawn) box.extend(vertex.px);
  const Eigen::AlignedBox2d picture(Eigen::Vector2d(0.0, 0.0),
                                    Eigen::Vector2d(camera_.width_px - 1, camera_.height_px - 1));
  box = box.intersection(picture);
  samples_.width_px = samples_.height_px = 0;
  if (!box.isEmpty()) {
    samples_.left_px = static_cast<int>(std::floor(box.min().x()));
    samples_.top_px = static_cast<int>(std::floor(box.min().y()));
    samples_.width_px = static_cast<int>(std::ceil(box.max().x())) - samples_.left_px + 1;
    samples_.height_px = static_cast<int>(std::ceil(box.max().y())) - samples_.top_px + 1;
  }
  const double depth =
      (motion.R_cur_from_ref * Eigen::Vector3d(surface_.axis_x, surface_.axis_y, 1.0) + motion.t_over_d).z();
  const double ref_px_per_px = depth * reference_camera_.fx / camera_.fx;
  samples_.per_pixel =
      static_cast<int>(std::ceil(std::clamp(ref_px_per_px, double{kMinSamples}, double{kMaxSamples})));
  const std::size_t count = static_cast<std::size_t>(samples_.width_px * samples_.per_pixel) *
                            static_cast<std::size_t>(samples_.height_px * samples_.per_pixel);
  samples_.grey.assign(count, 0.f);
  samples_.depth.assign(count, std::numeric_limits<float>::infinity());
}

/// Draws one triangle of the back; nothing if the camera sees its inner side.
void BackPicture::draw_triangle(const Vertex& a, const Vertex& b, const Vertex& c) {
  if (!(std::min({a.depth, b.depth, c.depth}) > kNearestDrawn)) return;
  const double s = samples_.per_pixel;
  const auto in_samples = [&](const Vertex& vertex) -> Eigen::Vector2d {
    return ((vertex.px - Eigen::Vector2d(samples_.left_px, samples_.top_px)).array() + 0.5) * s - 0.5;
  };
  const Eigen::Vector2d pa = in_samples(a), pb = in_samples(b), pc = in_samples(c);
  const double area = cross(pb - pa, pc - pa);
  if (!(area > 1e-9)) return;
  const double ref_area = std::abs(cross(b.ref_px - a.ref_px, c.ref_px - a.ref_px));
  const auto level = static_cast<std::size_t>(std::clamp(std::lround(0.5 * std::log2(ref_area / area)), 0L,
                                                         static_cast<long>(GreyPyramid::kLevels) - 1));

  const int columns = samples_.width_px * samples_.per_pixel, rows = samples_.height_px * samples_.per_pixel;
  const int first_x = std::max(0, static_cast<int>(std::ceil(std::min({pa.x(), pb.x(), pc.x()}))));
  const int last_x = std::min(columns - 1, static_cast<int>(std::floor(std::max({pa.x(), pb.x(), pc.x()}))));
  const int first_y = std::max(0, static_cast<int>(std::ceil(std::min({pa.y(), pb.y(), pc.y()}))));
  const int last_y = std::min(rows - 1, static_cast<int>(std::floor(std::max({pa.y(), pb.y(), pc.y()}))));
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const Eigen::Vector2d p(x, y);
      const double of_b = cross(p - pa, pc - pa) / area, of_c = cross(pb - pa, p - pa) / area;
      const double of_a = 1.0 - of_b - of_c;
      if (std::min({of_a, of_b, of_c}) < 0.0) continue;
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
      const auto depth = static_cast<float>(of_a * a.depth + of_b * b.depth + of_c * c.depth);
      if (depth >= samples_.depth[i]) continue;
      samples_.depth[i] = depth;
      samples_.grey[i] = reference_.at(of_a * a.ref_px + of_b * b.ref_px + of_c * c.ref_px, level);
    }
  }
}

void BackPicture::blend(std::vector<float>& frame) const {
  const int s = samples_.per_pixel;
  const auto columns = static_cast<std::size_t>(samples_.width_px * s);
  for (int y = 0; y < samples_.height_px; ++y) {
    for (int x = 0; x < samples_.width_px; ++x) {
      float sum = 0.f, covered = 0.f;
      for (int j = 0; j < s; ++j) {
        for (int i = 0; i < s; ++i) {
          const std::size_t sample =
              static_cast<std::size_t>(y * s + j) * columns + static_cast<std::size_t>(x * s + i);
          if (!std::isfinite(samples_.depth[sample])) continue;
          sum += samples_.grey[sample];
          covered += 1.f;
        }
      }
      float& pixel =
          frame[static_cast<std::size_t>(samples_.top_px + y) * static_cast<std::size_t>(camera_.width_px) +
                static_cast<std::size_t>(samples_.left_px + x)];
      const auto all = static_cast<float>(s * s);
      pixel = (sum + (all - covered) * pixel) / all;
    }
  }
}

}  // namespace heel
