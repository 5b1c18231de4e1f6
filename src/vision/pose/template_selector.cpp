#include "vision/pose/template_selector.h"

#include <Eigen/Core>
#include <string>

#include "heel/error.h"

namespace heel {
namespace {

// A pose this old still predicts where the person is.
constexpr TimeNs kLongestPrediction_ns = kNsPerS;
// The person is not farther from there than this: the places of two templates differ by a little, and person
// and robot move.
constexpr double kSamePlace_m = 0.4, kFastest_m_s = 2.0;

double distance_m(const PoseEstimate& a, const PoseEstimate& b) {
  return (Eigen::Map<const Eigen::Vector3d>(a.position_m.data()) -
          Eigen::Map<const Eigen::Vector3d>(b.position_m.data()))
      .norm();
}

bool at_the_same_place(const PoseEstimate& before, const PoseEstimate& now) {
  const double dt_s = seconds_from_ns(now.t_capture_ns - before.t_capture_ns);
  return distance_m(before, now) < kSamePlace_m + kFastest_m_s * dt_s;
}

void require_distance(std::span<const ShirtTemplate> templates) {
  for (std::size_t i = 0; i < templates.size(); ++i)
    if ((templates.size() > 1 || templates[i].yaw_rad != 0.0) && !(templates[i].distance_m > 0.0))
      throw Error("template " + std::to_string(i + 1) + " of " + std::to_string(templates.size()) +
                  ": has no distance (expected one: poses by several templates, or by one that was not "
                  "taken from behind, are compared in metres)");
}

}  // namespace

TemplateSelector::TemplateSelector(std::span<const ShirtTemplate> templates, const CameraModel& camera,
                                   const VisionConfig& config)
    : tracking_(config.tracking) {
  require_distance(templates);
  trackers_.reserve(templates.size());
  pose_of_back_.reserve(templates.size());
  const ShirtTemplate* first = &templates.front();
  for (const ShirtTemplate& shirt : templates) {
    if (shirt.is_first) first = &shirt;
    trackers_.emplace_back(shirt, camera, config);
    pose_of_back_.emplace_back(shirt, *first);
  }
}

void TemplateSelector::report_stage_times(StageTimes* times) {
  for (PoseTracker& tracker : trackers_) tracker.report_stage_times(times);
}

PoseEstimate TemplateSelector::estimate(const FrameView& frame) {
  PoseEstimate pose = tracking_ ? estimate_in_turn(frame) : estimate_alone(frame);
  pose.picture = picture_monitor_.update(frame);
  return pose;
}

/// The current template first; where it is not found, one other.
PoseEstimate TemplateSelector::estimate_in_turn(const FrameView& frame) {
  PoseEstimate pose = estimate_with(current_, frame);
  // A frame that shows two persons does not say which of them another template would find.
  if (!pose.found() && pose.reason != PoseReason::Ambiguous && trackers_.size() > 1)
    pose = try_another(frame, pose);
  else
    candidate_.reset();
  if (pose.found()) last_found_ = pose;
  return pose;
}

PoseEstimate TemplateSelector::estimate_alone(const FrameView& frame) {
  const PoseEstimate by_first = estimate_with(0, frame);
  PoseEstimate pose = by_first;
  for (std::size_t i = 1; i < trackers_.size() && !pose.found(); ++i) {
    if (pose.reason == PoseReason::Ambiguous) return pose;
    pose = estimate_with(i, frame);
  }
  return pose.found() || pose.reason == PoseReason::Ambiguous ? pose : by_first;
}

PoseEstimate TemplateSelector::estimate_with(std::size_t index, const FrameView& frame) {
  PoseEstimate pose = trackers_[index].estimate(frame);
  pose.template_index = static_cast<std::uint32_t>(index);
  return pose_of_back_[index].in_terms_of_back(pose);
}

/// The pose by another template if it takes over; else `refused`.
PoseEstimate TemplateSelector::try_another(const FrameView& frame, const PoseEstimate& refused) {
  // The one that was found in the last frame is searched again.
  std::size_t index = candidate_ ? candidate_->template_index : next_;
  if (index == current_) index = (index + 1) % trackers_.size();
  next_ = (index + 1) % trackers_.size();
  const PoseEstimate pose = estimate_with(index, frame);
  if (!pose.found()) {
    candidate_.reset();
    return refused;
  }
  if (takes_over(pose)) {
    candidate_.reset();
    current_ = index;
    return pose;
  }
  candidate_ = pose;
  return refused;
}

bool TemplateSelector::takes_over(const PoseEstimate& pose) const {
  const TimeNs age_ns = pose.t_capture_ns - last_found_.t_capture_ns;
  if (last_found_.found() && age_ns >= 0 && age_ns < kLongestPrediction_ns)
    return at_the_same_place(last_found_, pose);
  return candidate_ && candidate_->template_index == pose.template_index &&
         at_the_same_place(*candidate_, pose);
}

}  // namespace heel
