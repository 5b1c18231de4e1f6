#include "evaluation/benchmarks/geometry_problem.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <utility>

#include "core/random.h"

namespace heel::evaluation {
namespace {

constexpr int kPairs = 200;
constexpr int kWrong = 100;
constexpr double kNoise_px = 1.0;
constexpr double kFocal_px = 600.0;
constexpr double kViewWidth_px = 640.0, kViewHeight_px = 480.0;
// The region of the reference view that is the shirt's back.
constexpr double kRegionLeft_px = 240.0, kRegionRight_px = 400.0, kRegionTop_px = 140.0,
                 kRegionBottom_px = 340.0;

const std::array<Eigen::Vector2d, 4> kCorners_px{
    Eigen::Vector2d(kRegionLeft_px, kRegionTop_px), Eigen::Vector2d(kRegionRight_px, kRegionTop_px),
    Eigen::Vector2d(kRegionRight_px, kRegionBottom_px), Eigen::Vector2d(kRegionLeft_px, kRegionBottom_px)};

Eigen::Matrix3d camera_matrix() {
  Eigen::Matrix3d K;
  K << kFocal_px, 0, 0.5 * (kViewWidth_px - 1), 0, kFocal_px, 0.5 * (kViewHeight_px - 1), 0, 0, 1;
  return K;
}

/// R + t/d nᵀ: the back turned by up to a radian, seen at 0.6 to 1.8 times the reference distance.
Eigen::Matrix3d random_motion(Random& random) {
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(random.uniform(-1.0, 1.0), Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(random.uniform(-0.15, 0.15), Eigen::Vector3d::UnitX()) *
                             Eigen::AngleAxisd(random.uniform(-0.1, 0.1), Eigen::Vector3d::UnitZ()))
                                .toRotationMatrix();
  const double depth = random.uniform(0.6, 1.8);
  const Eigen::Vector3d centre(random.uniform(-0.25, 0.25) * depth, random.uniform(-0.15, 0.15) * depth,
                               depth);
  const Eigen::Vector3d t_over_d = centre - R * Eigen::Vector3d::UnitZ();
  return R + t_over_d * Eigen::RowVector3d::UnitZ();
}

Eigen::Vector2d mapped(const Eigen::Matrix3d& H, const Eigen::Vector2d& point) {
  return (H * point.homogeneous()).hnormalized();
}

Eigen::Vector2d point_in_region(Random& random) {
  const double x_px = random.uniform(kRegionLeft_px, kRegionRight_px);
  return {x_px, random.uniform(kRegionTop_px, kRegionBottom_px)};
}

Eigen::Vector2d point_in_view(Random& random) {
  const double x_px = random.uniform(0.0, kViewWidth_px);
  return {x_px, random.uniform(0.0, kViewHeight_px)};
}

Eigen::Vector2d noise(Random& random) {
  const double x_px = kNoise_px * random.normal();
  return {x_px, kNoise_px * random.normal()};
}

cv::Point2f as_opencv(const Eigen::Vector2d& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y())};
}

}  // namespace

double GeometryProblem::corner_error_px(const Eigen::Matrix3d& H) const {
  double sum_px = 0.0;
  for (const Eigen::Vector2d& corner : kCorners_px)
    sum_px += (mapped(H, corner) - mapped(H_cur_from_ref, corner)).norm();
  return sum_px / static_cast<double>(kCorners_px.size());
}

GeometryProblem make_geometry_problem(std::uint64_t seed) {
  Random random(seed);
  const Eigen::Matrix3d K = camera_matrix();
  GeometryProblem problem;
  problem.A_cur_from_ref = random_motion(random);
  problem.H_cur_from_ref = K * problem.A_cur_from_ref * K.inverse();
  for (int i = 0; i < kPairs; ++i) {
    const Eigen::Vector2d ref = point_in_region(random);
    const Eigen::Vector2d cur = i < kWrong
                                    ? point_in_view(random)
                                    : Eigen::Vector2d(mapped(problem.H_cur_from_ref, ref) + noise(random));
    problem.pairs.push_back({ref, cur});
  }
  for (int i = kPairs - 1; i > 0; --i)
    std::swap(problem.pairs[static_cast<std::size_t>(i)],
              problem.pairs[static_cast<std::size_t>(random.index(i + 1))]);
  for (const PointPair& pair : problem.pairs) {
    problem.ref.push_back(as_opencv(pair.ref_px));
    problem.cur.push_back(as_opencv(pair.cur_px));
  }
  return problem;
}

}  // namespace heel::evaluation
