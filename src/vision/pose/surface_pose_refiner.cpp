#include "vision/pose/surface_pose_refiner.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "heel/motion.h"

namespace heel {
namespace {

constexpr std::size_t kMinObservations = 10;
constexpr std::size_t kMaxPairs = 500;
constexpr int kStepsPerRound = 4, kStepsOfLastRound = 8;
constexpr double kMinDepth = 0.1;  // in units of d: nearer points are taken to be behind the camera
constexpr double kFits = 0.3;      // least weight of a patch that is where the pose puts it

// Features on cloth are placed this precisely; patches no more precisely than the second number.
constexpr double kFeatureNoise_px = 0.7, kMinPatchNoise_px = 0.1;
// A patch about which the grey levels say nothing is known within 10 px.
constexpr double kMinInformation_1_px2 = 0.01;

// With this share of the patches in place no other pose is tried.
constexpr double kSufficientAgreement = 0.75;
// The features support the first pose: another one replaces it if its score is this many times larger.
constexpr double kBetter = 1.1;

// A patch that moves otherwise than the median of its neighbours by more than cloth does is mistaken.
constexpr double kUnlike_m = 0.008, kUnlike_px = 1.6;
constexpr std::size_t kMinNeighbours = 3;

template <std::size_t Size>
double median(std::array<double, Size>& values, std::size_t count) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

}  // namespace

FrontalMotion turned(const FrontalMotion& motion, double turn_rad, const BackSurface& surface) {
  const Eigen::Vector3d middle(surface.axis_x, surface.axis_y, 1.0);
  FrontalMotion start;
  start.R_cur_from_ref =
      Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix() * motion.R_cur_from_ref;
  start.t_over_d = motion.t_over_d + (motion.R_cur_from_ref - start.R_cur_from_ref) * middle;
  return start;
}

FrontalPose frontal_pose(const SurfacePose& pose) {
  FrontalPose frontal;
  frontal.motion = frontal.other = pose.motion;
  frontal.covariance = pose.covariance;
  frontal.yaw_rad = yaw_of_rotation(pose.motion.R_cur_from_ref);
  frontal.yaw_sigma_rad = yaw_sigma_rad(pose.motion.R_cur_from_ref, pose.covariance);
  frontal.t_over_d_sigma = pose.covariance.diagonal().tail<3>().cwiseSqrt();
  return frontal;
}

SurfacePoseRefiner::SurfacePoseRefiner(const ShirtTemplate& shirt, const CameraModel& current_camera)
    : camera_(current_camera),
      K_cur_(current_camera.K()),
      K_ref_inverse_(shirt.camera.K().inverse()),
      ref_px_per_m_(shirt.distance_m > 0.0 ? shirt.camera.fx / shirt.distance_m : 0.0),
      aligner_(shirt, PatchSettings{}),
      solver_(K_cur_, aligner_.centres_px().size() + kMaxPairs) {
  const std::span<const Eigen::Vector2d> centres_px = aligner_.centres_px();
  const auto ray = [&](const Eigen::Vector2d& px) -> Eigen::Vector3d {
    return K_ref_inverse_ * shirt.camera.undistort_px(px).homogeneous();
  };
  for (const Eigen::Vector2d& px : centres_px)
    rays_.push_back({ray(px), ray(px + Eigen::Vector2d::UnitX()), ray(px + Eigen::Vector2d::UnitY())});
  std::vector<std::size_t> nearest;
  for (std::size_t i = 0; i < centres_px.size(); ++i) nearest.push_back(i);
  for (const Eigen::Vector2d& px : centres_px) {
    std::stable_sort(nearest.begin(), nearest.end(), [&](std::size_t a, std::size_t b) {
      return (centres_px[a] - px).squaredNorm() < (centres_px[b] - px).squaredNorm();
    });
    std::array<std::size_t, kNeighbours> neighbours{};  // without the patch itself, which is the nearest
    for (std::size_t k = 0; k < kNeighbours; ++k)
      neighbours[k] = nearest[std::min(k + 1, nearest.size() - 1)];
    neighbours_.push_back(neighbours);
  }
  predicted_.resize(centres_px.size());
  aligned_.reserve(centres_px.size());
  kept_.reserve(centres_px.size());
  residuals_px_.reserve(centres_px.size());
  aligned_index_.resize(centres_px.size());
  observations_.reserve(solver_.max_observations());
}

std::optional<SurfacePose> SurfacePoseRefiner::refine(const FrameView& frame, const BackSurface& surface,
                                                      std::span<const PointPair> pairs,
                                                      const FrontalMotion& start, int rounds) {
  SurfacePose pose;
  pose.motion = start;
  for (int round = 1; round <= rounds; ++round) {
    predict(surface, pose.motion);
    aligner_.align(frame, predicted_, aligned_);
    drop_unlike_neighbours();
    observe(pairs);
    if (observations_.size() < kMinObservations) return std::nullopt;
    pose.motion = solver_.solve(surface, observations_, pose.motion,
                                round < rounds ? kStepsPerRound : kStepsOfLastRound);
  }
  for (std::size_t i = 0; i < aligned_.size(); ++i) {
    if (solver_.weight(i) > kFits) ++pose.patches;
    pose.score += 1.0 - solver_.cost(i) / SurfacePoseSolver::kMaxCost;
  }
  pose.residual_px = median_residual_px();
  const auto visible = std::count_if(predicted_.begin(), predicted_.end(),
                                     [](const PredictedPatch& patch) { return patch.visible(); });
  pose.agreement = static_cast<double>(pose.patches) / std::max(1.0, static_cast<double>(visible));
  pose.covariance = solver_.covariance();
  return pose;
}

double SurfacePoseRefiner::median_residual_px() {
  residuals_px_.clear();
  for (std::size_t i = 0; i < aligned_.size(); ++i) residuals_px_.push_back(solver_.residual_px(i));
  if (residuals_px_.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = residuals_px_.begin() + static_cast<std::ptrdiff_t>(residuals_px_.size() / 2);
  std::nth_element(residuals_px_.begin(), middle, residuals_px_.end());
  return *middle;
}

SurfacePose SurfacePoseRefiner::refine_turned(const FrameView& frame, const BackSurface& surface,
                                              const SurfacePose& pose, std::span<const double> turns_rad,
                                              int rounds) {
  SurfacePose best = pose;
  if (pose.agreement >= kSufficientAgreement) return best;
  for (const double turn_rad : turns_rad) {
    const std::optional<SurfacePose> other =
        refine(frame, surface, {}, turned(pose.motion, turn_rad, surface), rounds);
    if (other && other->score > kBetter * best.score) best = *other;
  }
  return best;
}

void SurfacePoseRefiner::predict(const BackSurface& surface, const FrontalMotion& motion) {
  const Eigen::Matrix3d KR = K_cur_ * motion.R_cur_from_ref;
  const Eigen::Vector3d Kt = K_cur_ * motion.t_over_d;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    std::array<Eigen::Vector2d, 3> px;
    bool in_front = true;
    for (std::size_t k = 0; k < px.size(); ++k) {
      const Eigen::Vector3d pixel = KR * surface.point(rays_[i][k]) + Kt;
      in_front = in_front && pixel.z() > kMinDepth;
      px[k] = camera_.distort_px(pixel.hnormalized());
    }
    predicted_[i] = {};
    if (!in_front) continue;
    predicted_[i].px = px[0];
    predicted_[i].cur_from_ref << px[1] - px[0], px[2] - px[0];
  }
}

void SurfacePoseRefiner::drop_unlike_neighbours() {
  std::fill(aligned_index_.begin(), aligned_index_.end(), -1);
  for (std::size_t i = 0; i < aligned_.size(); ++i)
    aligned_index_[aligned_[i].patch] = static_cast<std::ptrdiff_t>(i);
  kept_.clear();
  for (const AlignedPatch& patch : aligned_)
    if (moves_like_neighbours(patch)) kept_.push_back(patch);
  std::swap(aligned_, kept_);
}

bool SurfacePoseRefiner::moves_like_neighbours(const AlignedPatch& patch) const {
  const auto shift_px = [&](const AlignedPatch& a) -> Eigen::Vector2d {
    return a.px - predicted_[a.patch].px;
  };
  std::array<double, kNeighbours> x{}, y{};
  std::size_t count = 0;
  for (const std::size_t neighbour : neighbours_[patch.patch]) {
    if (aligned_index_[neighbour] < 0 || neighbour == patch.patch) continue;
    const Eigen::Vector2d shift = shift_px(aligned_[static_cast<std::size_t>(aligned_index_[neighbour])]);
    x[count] = shift.x();
    y[count] = shift.y();
    ++count;
  }
  if (count < kMinNeighbours) return true;
  const double px_per_m = ref_px_per_m_ * std::sqrt(predicted_[patch.patch].cur_from_ref.determinant());
  const double noise_px = std::sqrt(1.0 / std::max(1.0, patch.information.trace()));
  const double limit_px = std::max(kUnlike_m * px_per_m, kUnlike_px + 2.0 * noise_px);
  return (shift_px(patch) - Eigen::Vector2d(median(x, count), median(y, count))).norm() < limit_px;
}

void SurfacePoseRefiner::observe(std::span<const PointPair> pairs) {
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  observations_.clear();
  for (const AlignedPatch& patch : aligned_)
    observations_.push_back({rays_[patch.patch][0], camera_.undistort_px(patch.px),
                             (patch.information + kMinInformation_1_px2 * I).inverse() +
                                 kMinPatchNoise_px * kMinPatchNoise_px * I});
  for (const PointPair& pair : pairs.first(std::min(pairs.size(), kMaxPairs)))
    observations_.push_back(
        {K_ref_inverse_ * pair.ref_px.homogeneous(), pair.cur_px, kFeatureNoise_px * kFeatureNoise_px * I});
}

}  // namespace heel
