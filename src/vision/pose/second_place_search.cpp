#include "vision/pose/second_place_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <span>

#include "vision/homography/homography_4pt.h"
#include "vision/homography/shape_plausibility.h"
#include "vision/matching/guided_matcher.h"

namespace heel {
namespace {

constexpr double kReliableCertainty = 0.1;  // of the paper: following may start
constexpr double kComparableShare = 0.5;
// The outline under H is that of a plane: a turned back extends farther, and its print beyond the region.
constexpr double kOutlineMargin = 1.3;

/// The outline in the frame, larger by the margin.
Outline place_of(const Eigen::Matrix3d& H_cur_from_ref, const Outline& outline_ref_px) {
  Outline outline;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    outline[i] = (H_cur_from_ref * outline_ref_px[i].homogeneous()).hnormalized();
    centre += 0.25 * outline[i];
  }
  for (Eigen::Vector2d& corner : outline) corner = centre + kOutlineMargin * (corner - centre);
  return outline;
}

/// `outline` is convex, clockwise as seen (y down).
bool inside(const Outline& outline, const Eigen::Vector2d& px) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d edge = outline[(i + 1) % outline.size()] - outline[i], to_px = px - outline[i];
    if (edge.x() * to_px.y() - edge.y() * to_px.x() < 0.0) return false;
  }
  return true;
}

}  // namespace

SecondPlaceSearch::SecondPlaceSearch(const ReferenceView& reference, TemplateMatcher& matcher,
                                     PlaneFitter& plane_fitter, ViewSearch& view_search,
                                     int max_frame_features)
    : reference_(reference),
      matcher_(matcher),
      plane_fitter_(plane_fitter),
      view_search_(view_search),
      grid_(max_frame_features, GuidedMatchSettings{}.radius_px) {
  const auto capacity = static_cast<std::size_t>(max_frame_features);
  outside_.features.reserve(capacity);
  outside_.descriptors.reserve(capacity);
  outside_px_.reserve(capacity);
}

bool SecondPlaceSearch::shows_second_place(const FrameView& frame, const FeatureGrid& features,
                                           const PoseEstimate& found, PoseWorkspace& work) {
  const double enough = std::min(kReliableCertainty, kComparableShare * found.certainty);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> H_cur_from_ref(
      found.H_cur_from_ref.data());
  const Outline place = place_of(H_cur_from_ref, reference_.outline_px);
  const auto elsewhere = [&](const Eigen::Matrix3d& H) {
    return !inside(place, (H * reference_.centre_px.homogeneous()).hnormalized());
  };
  const FeatureGrid& outside = features_outside(place, features);
  const std::span<const Match> matches = matcher_.match_everywhere(outside.features());
  if (matches.size() >= kHomographyPairs) {
    PlaneFit fit = plane_fitter_.fit(matches, outside, work);
    if (fit.found()) fit = plane_fitter_.fit_guided(fit, matcher_, outside, work);
    if (fit.found() && fit.certainty >= enough && elsewhere(fit.H_cur_from_ref)) return true;
  }
  const ViewDetection seen = view_search_.search(frame, {outside, 1.0});
  return seen.found() && seen.certainty >= enough && elsewhere(seen.H_cur_from_ref);
}

const FeatureGrid& SecondPlaceSearch::features_outside(const Outline& place, const FeatureGrid& features) {
  outside_.features.clear();
  outside_.descriptors.clear();
  outside_px_.clear();
  for (std::size_t i = 0; i < features.undistorted_px().size(); ++i) {
    const Eigen::Vector2d& px = features.undistorted_px()[i];
    if (inside(place, px)) continue;
    outside_.features.push_back(features.features().features[i]);
    outside_.descriptors.push_back(features.features().descriptors[i]);
    outside_px_.push_back(px);
  }
  grid_.assign(outside_, outside_px_);
  return grid_;
}

}  // namespace heel
