#include "vision/pose/view_voter.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace heel {
namespace {

constexpr std::size_t kMaxCandidates = 3;  // the back is nearly always the first
constexpr std::size_t kMaxVotePairs = 200;
// A weak test: a candidate needs few matches, and wrong ones vote for places all over the frame.
constexpr float kVoteRatio = 0.95f;
// Votes agree when their places differ by less than this share of the back's longer side, the logarithms
// of their sizes by less than this, and their views are neighbours.
constexpr double kSamePlace = 0.25, kSameLogScale = 0.53, kSameYaw_rad = 0.8;
constexpr double kMinSupport = 2.0;  // of a candidate; one vote in the right place counts 1, at the limit ½
// The pose of a candidate starts from the votes' mean and is fitted to their pairs within these limits.
constexpr int kVoteSteps = 6;
constexpr double kPairNoise_px = 2.0;
constexpr double kVoteTurnSigma_rad = 0.3, kVoteTiltSigma_rad = 0.1, kVotePlaceShare = 0.2,
                 kVoteDepthShare = 0.25;

std::size_t features_of(std::span<const TemplateView> views) {
  std::size_t count = 0;
  for (const TemplateView& view : views) count += view.set.features.size();
  return count;
}

}  // namespace

ViewVoter::ViewVoter(std::span<const TemplateView> views, const BackSurface& surface,
                     const CameraModel& reference_camera, const CameraModel& current_camera,
                     int max_frame_features)
    : views_(views),
      surface_(surface),
      K_ref_inverse_(reference_camera.K().inverse()),
      K_cur_inverse_(current_camera.K().inverse()),
      focal_ratio_(
          std::sqrt(current_camera.fx * current_camera.fy / (reference_camera.fx * reference_camera.fy))),
      region_side_px_(2.0 * std::max(surface.half_size.x() * reference_camera.fx,
                                     surface.half_size.y() * reference_camera.fy)),
      matcher_(static_cast<int>(features_of(views)), max_frame_features,
               MatchSettings{.ratio = kVoteRatio, .mutual = true}),
      solver_(current_camera.K(), kMaxVotePairs) {
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (std::size_t i = 0; i < views[v].set.features.size(); ++i) {
      view_features_.features.push_back(views[v].set.features[i]);
      view_features_.descriptors.push_back(views[v].set.descriptors[i]);
      view_of_.push_back(v);
      index_in_view_.push_back(i);
    }
  }
  // A match uses up a feature of either side.
  const std::size_t max_matches = std::min(view_of_.size(), static_cast<std::size_t>(max_frame_features));
  matches_.reserve(view_of_.size());
  votes_.reserve(max_matches);
  observations_.reserve(kMaxVotePairs);
  candidates_.reserve(kMaxCandidates);
}

std::span<const FrontalMotion> ViewVoter::candidates(const FeatureGrid& frame) {
  cast_votes(frame);
  candidates_.clear();
  while (candidates_.size() < kMaxCandidates) {
    const Vote* seed = nullptr;
    double most = kMinSupport;
    for (const Vote& vote : votes_) {
      const double of_vote = vote.used ? 0.0 : support(vote);
      if (of_vote > most || (seed == nullptr && of_vote == most)) {
        most = of_vote;
        seed = &vote;
      }
    }
    if (seed == nullptr) break;
    const FrontalMotion candidate = candidate_of(*seed);
    if (candidate.t_over_d.allFinite()) candidates_.push_back(candidate);
  }
  return candidates_;
}

void ViewVoter::cast_votes(const FeatureGrid& frame) {
  matcher_.match(view_features_, frame.features(), matches_);
  votes_.clear();
  for (const Match& match : matches_) {
    const auto ref = static_cast<std::size_t>(match.ref), cur = static_cast<std::size_t>(match.cur);
    const TemplateView& view = views_[view_of_[ref]];
    const std::size_t i = index_in_view_[ref];
    const double scale = static_cast<double>(frame.features().features[cur].sigma_px) /
                         static_cast<double>(view.set.features[i].sigma_px);
    const Eigen::Vector2d& cur_px = frame.undistorted_px()[cur];
    const double log_scale = std::log(view.scale * scale);
    votes_.push_back({cur_px + scale * view.to_centre_px[i], log_scale,
                      kSamePlace * region_side_px_ * view.scale * scale, view.yaw_rad,
                      K_ref_inverse_ * view.ref_px[i].homogeneous(), cur_px, false});
  }
}

bool ViewVoter::agree(const Vote& seed, const Vote& other) {
  return !other.used && std::abs(other.log_scale - seed.log_scale) < kSameLogScale &&
         std::abs(other.yaw_rad - seed.yaw_rad) < kSameYaw_rad &&
         (other.centre_px - seed.centre_px).squaredNorm() < seed.reach_px * seed.reach_px;
}

double ViewVoter::support(const Vote& seed) const {
  double sum = 0.0;
  for (const Vote& other : votes_)
    if (agree(seed, other)) sum += 1.0 - 0.5 * (other.centre_px - seed.centre_px).norm() / seed.reach_px;
  return sum;
}

/// The mean of the votes that agree with `seed`, fitted to their pairs. Uses them up.
FrontalMotion ViewVoter::candidate_of(const Vote& seed) {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  double log_scale = 0.0, yaw_rad = 0.0, count = 0.0;
  observations_.clear();
  for (Vote& vote : votes_) {
    if (!agree(seed, vote)) continue;
    vote.used = true;
    centre_px += vote.centre_px;
    log_scale += vote.log_scale;
    yaw_rad += vote.yaw_rad;
    count += 1.0;
    if (observations_.size() < kMaxVotePairs)
      observations_.push_back(
          {vote.ray, vote.cur_px, kPairNoise_px * kPairNoise_px * Eigen::Matrix2d::Identity()});
  }
  centre_px /= count;
  const double depth = focal_ratio_ / std::exp(log_scale / count);
  FrontalMotion start;
  start.R_cur_from_ref = Eigen::AngleAxisd(yaw_rad / count, Eigen::Vector3d::UnitY()).toRotationMatrix();
  start.t_over_d = depth * (K_cur_inverse_ * centre_px.homogeneous()) -
                   start.R_cur_from_ref * Eigen::Vector3d(surface_.axis_x, surface_.axis_y, 1.0);
  const MotionPrior prior{{kVoteTiltSigma_rad, kVoteTurnSigma_rad, kVoteTiltSigma_rad},
                          depth * Eigen::Vector3d(kVotePlaceShare, kVotePlaceShare, kVoteDepthShare)};
  return solver_.solve(surface_, observations_, start, kVoteSteps, prior);
}

}  // namespace heel
