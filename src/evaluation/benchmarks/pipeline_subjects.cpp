#include <span>
#include <type_traits>
#include <utility>

#include "evaluation/benchmarks/subjects.h"
#include "heel/pose_estimator.h"
#include "vision/pose/template_selector.h"

namespace heel::evaluation {
namespace {

constexpr double kSearchGoal = 1.3, kTrackingGoal = 0.4;  // × cv::ORB(1000)
constexpr double kFarShirtGoal = 1.3;                     // × cv::ORB(3000)
constexpr int kFarShirtOrbFeatures = 3000;

/// With the daemon's default settings.
template <typename Vision>
Vision made_of(const BenchInput& input) {
  if constexpr (std::is_same_v<Vision, TemplateSelector>) {
    return Vision(std::span(&input.shirt, 1), input.camera, VisionConfig{});
  } else {
    return Vision(input.shirt, input.camera, VisionConfig{});
  }
}

/// The daemon's vision stage is TemplateSelector; PoseEstimator searches each frame by itself.
template <typename Vision>
class HeelVision : public PipelineSubject {
 public:
  HeelVision(const BenchInput& input, Figure what)
      : PipelineSubject(std::move(what)), input_(input), vision_(made_of<Vision>(input)) {
    vision_.report_stage_times(stage_times());
  }

  double found_share() const override { return share(found_); }
  double tracked_share() const override { return share(tracked_); }
  std::uint32_t template_features() const override { return pose_.template_features; }

 protected:
  bool settle(std::size_t /*frame*/) override {
    ++frames_;
    features_ += pose_.frame_features;
    if (pose_.found()) ++found_;
    if (pose_.tracked) ++tracked_;
    return true;
  }
  void complete(Figure& figure) const override {
    if (frames_ > 0) figure.features = static_cast<double>(features_) / static_cast<double>(frames_);
  }
  const PoseEstimate& pose() const { return pose_; }

 private:
  void work(std::size_t index) override { pose_ = vision_.estimate(input_.frames[index].view(index)); }
  double share(std::size_t count) const {
    return frames_ > 0 ? static_cast<double>(count) / static_cast<double>(frames_) : 0.0;
  }

  const BenchInput& input_;
  Vision vision_;
  PoseEstimate pose_;
  std::size_t frames_ = 0, features_ = 0, found_ = 0, tracked_ = 0;
};

/// Only the frames count in which it had not to search everywhere.
class Tracking : public HeelVision<TemplateSelector> {
 public:
  using HeelVision::HeelVision;

 private:
  bool settle(std::size_t frame) override {
    HeelVision::settle(frame);
    return pose().tracked;
  }
};

/// As the daemon searches while it has no shirt to track: what it finds may come after several frames.
class FarShirtSearch : public HeelVision<TemplateSelector> {
 public:
  using HeelVision::HeelVision;

 private:
  void complete(Figure& figure) const override {
    HeelVision::complete(figure);
    figure.found_share = found_share();
    figure.pixels = kFarShirtSize.area();
  }
};

Figure figure_of(const BenchInput& input, const char* key, const char* label, double goal) {
  Figure figure{.key = key, .label = label, .yardstick = "orb_1000"};
  if (input.frames.front().grey.size() == kGoalSize) figure.goal = goal;
  return figure;
}

}  // namespace

std::unique_ptr<PipelineSubject> search_subject(const BenchInput& input) {
  return std::make_unique<HeelVision<PoseEstimator>>(
      input, figure_of(input, "search", "frame to pose, searching everywhere", kSearchGoal));
}

std::unique_ptr<PipelineSubject> tracking_subject(const BenchInput& input) {
  return std::make_unique<Tracking>(input,
                                    figure_of(input, "tracking", "frame to pose, tracking", kTrackingGoal));
}

Subjects far_shirt_subjects(const BenchInput& input) {
  Subjects subjects;
  subjects.push_back(
      std::make_unique<FarShirtSearch>(input, Figure{.key = "search_1080p",
                                                     .label = "searching, 1920x1080, shirt of 85 px",
                                                     .yardstick = "orb_3000",
                                                     .goal = kFarShirtGoal}));
  subjects.push_back(orb_subject(input, "orb_3000", "cv::ORB(3000), 1920x1080", kFarShirtOrbFeatures));
  return subjects;
}

}  // namespace heel::evaluation
