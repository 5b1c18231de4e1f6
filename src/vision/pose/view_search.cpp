#include "vision/pose/view_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "heel/motion.h"
#include "vision/features/upsampled_region.h"
#include "vision/pose/other_minimum.h"

namespace heel {
namespace {

// Far from frontal a candidate's mirror image in the line of sight may fit its few features as well: the
// patches decide.
constexpr double kMirrored_rad = 0.25;
// The few features of a small back leave its yaw open.
constexpr std::array kOtherTurns_rad{-0.6, -0.3, 0.3, 0.6};
constexpr int kViewPatchRounds = 3;
// Matches near a candidate are matches with any print that looks alike; so more of them must fit than of
// those that are distinct in the whole frame.
constexpr double kMinViewCertainty = 0.1;
// 99 % of true backs have at least 20 % of their visible patches in place; false candidates have at most 10
// %.
constexpr double kMinAgreement = 0.2;
constexpr std::size_t kMinPatches = 8;
constexpr double kSmallerFeatures = 0.8;

std::vector<TemplateView> views_of(const ShirtTemplate& shirt, const BackSurface& surface) {
  return surface.flat() ? std::vector<TemplateView>{} : make_views(shirt, surface);
}

Eigen::Matrix3d plane_homography(const Eigen::Matrix3d& K_cur, const FrontalMotion& motion,
                                 const Eigen::Matrix3d& K_ref_inverse) {
  const Eigen::Matrix3d H =
      K_cur * (motion.R_cur_from_ref + motion.t_over_d * Eigen::RowVector3d::Unit(2)) * K_ref_inverse;
  return H / H(2, 2);
}

}  // namespace

ViewSearch::ViewSearch(const ShirtTemplate& shirt, const ReferenceView& reference, const CameraModel& camera,
                       const VisionConfig& config, const BackSurface& surface,
                       const ShapeLimits& shape_limits, const ViewPredictor& predictor,
                       FrameFeatures& features, SurfacePoseRefiner& patch_refiner)
    : reference_(reference),
      predictor_(predictor),
      features_(features),
      patch_refiner_(patch_refiner),
      surface_(surface),
      shape_limits_(shape_limits),
      K_cur_(camera.K()),
      min_inliers_(static_cast<std::uint32_t>(config.min_inliers)),
      min_certainty_(std::max(kMinViewCertainty, config.min_certainty)),
      views_(views_of(shirt, surface)),
      voter_(views_, surface, shirt.camera, camera, config.max_features),
      confirmer_(views_, surface, shirt.camera, camera, config.max_features) {}

MagnifiedFeatures magnified(const FeatureGrid& grid, const ExpectedView& expected) {
  return {grid, expected.upsample ? UpsampledRegion::kFactor : 1.0};
}

ViewDetection ViewSearch::search(const FrameView& frame, const MagnifiedFeatures& found) {
  ViewDetection detection;
  if (views_.empty()) return detection;
  for (const FrontalMotion& candidate : voter_.candidates(found.grid)) {
    detection = confirm(frame, found, candidate);
    if (detection.found()) break;
  }
  return detection;
}

bool ViewSearch::plausible(const Eigen::Matrix3d& H_cur_from_ref) const {
  return H_cur_from_ref.allFinite() && plausible_shape(H_cur_from_ref, reference_.outline_px, shape_limits_);
}

ViewDetection ViewSearch::confirm(const FrameView& frame, const MagnifiedFeatures& found,
                                  const FrontalMotion& candidate) {
  ViewDetection detection;
  const Eigen::Matrix3d H_candidate = plane_homography(K_cur_, candidate, reference_.K_inverse);
  detection.reason = PoseReason::ImplausibleShape;
  if (!plausible(H_candidate)) return detection;

  ExpectedView near = predictor_.near_candidate(H_candidate);
  near.sigma_min_px = std::max(predictor_.whole_frame().sigma_min_px, kSmallerFeatures * near.sigma_min_px);
  detection.reason = PoseReason::TooFewInliers;
  // A back so large shows itself without the closer look, which only finds more of it.
  if (!near.upsample && !confirmer_.confirm(candidate, found.grid, found.magnification)) return detection;
  const MagnifiedFeatures look =
      magnified(features_.find(frame, near, FrameFeatures::Search::CloserLook), near);
  const std::optional<ConfirmedView> confirmed = confirmer_.confirm(candidate, look.grid, look.magnification);
  if (!confirmed) return detection;
  detection.inliers = static_cast<std::uint32_t>(confirmed->pairs.size());
  detection.view_features = static_cast<std::uint32_t>(confirmed->view_features);
  detection.certainty = static_cast<double>(detection.inliers) / detection.view_features;
  if (detection.inliers < min_inliers_ || detection.certainty < min_certainty_) return detection;

  std::optional<SurfacePose> pose =
      patch_refiner_.refine(frame, surface_, confirmed->pairs, confirmed->motion, kViewPatchRounds);
  detection.reason = PoseReason::PatchesDisagree;
  if (!pose) return detection;
  pose = patch_refiner_.refine_turned(frame, surface_, *pose, kOtherTurns_rad, kViewPatchRounds);
  std::optional<SurfacePose> mirrored;
  if (std::abs(yaw_of_rotation(pose->motion.R_cur_from_ref)) > kMirrored_rad)
    mirrored = refine_mirrored(frame, look, *pose);
  if (mirrored && mirrored->score > pose->score) std::swap(pose, mirrored);
  if (pose->agreement < kMinAgreement || pose->patches < kMinPatches) return detection;

  detection.H_cur_from_ref = plane_homography(K_cur_, pose->motion, reference_.K_inverse);
  detection.pose = mirrored ? weighed(*pose, *mirrored) : frontal_pose(*pose);
  detection.reason = plausible(detection.H_cur_from_ref) ? PoseReason::Found : PoseReason::ImplausibleShape;
  return detection;
}

/// From the mirror image of `pose` in the line of sight, with its own pairs where there are any: those of the
/// other pose hold it back.
std::optional<SurfacePose> ViewSearch::refine_mirrored(const FrameView& frame,
                                                       const MagnifiedFeatures& features,
                                                       const SurfacePose& pose) {
  const FrontalProblem problem{{}, reference_.K, K_cur_, {}, reference_.centre_px, surface_};
  const PlaneMotion mirrored = mirrored_motion(problem, pose.motion);
  FrontalMotion start;
  start.R_cur_from_ref = mirrored.R_cur_from_ref;
  start.t_over_d = mirrored.t_over_d;
  const std::optional<ConfirmedView> confirmed =
      confirmer_.confirm(start, features.grid, features.magnification);
  std::optional<SurfacePose> by_patches = patch_refiner_.refine(frame, surface_, {}, start, kViewPatchRounds);
  if (!confirmed) return by_patches;
  const std::optional<SurfacePose> with_pairs =
      patch_refiner_.refine(frame, surface_, confirmed->pairs, confirmed->motion, kViewPatchRounds);
  return with_pairs && !(by_patches && by_patches->score > with_pairs->score) ? with_pairs : by_patches;
}

}  // namespace heel
