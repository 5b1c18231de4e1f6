#include <opencv2/features2d.hpp>
#include <utility>

#include "evaluation/benchmarks/subjects.h"
#include "heel/features.h"

namespace heel::evaluation {
namespace {

constexpr int kOrbFeatures = 1000;

/// Counts what was found, frame by frame.
class FeatureCountingSubject : public Subject {
 public:
  FeatureCountingSubject(const BenchInput& input, Figure what) : Subject(std::move(what)), input_(input) {}

 protected:
  virtual std::size_t found() const = 0;
  bool settle(std::size_t /*frame*/) override {
    features_ += found();
    ++frames_;
    return true;
  }
  void complete(Figure& figure) const override {
    if (frames_ > 0) figure.features = static_cast<double>(features_) / static_cast<double>(frames_);
  }
  const BenchFrame& frame(std::size_t index) const { return input_.frames[index]; }

 private:
  const BenchInput& input_;
  std::size_t features_ = 0, frames_ = 0;
};

class HeelFeatures : public FeatureCountingSubject {
 public:
  HeelFeatures(const BenchInput& input, Figure what)
      : FeatureCountingSubject(input, std::move(what)),
        extractor_(input.camera.width_px, input.camera.height_px, FeatureSettings{}) {
    extractor_.reserve(found_);
    extractor_.report_stage_times(stage_times());
  }

 private:
  void work(std::size_t index) override { extractor_.extract(frame(index).view(index), found_); }
  std::size_t found() const override { return found_.features.size(); }

  FeatureExtractor extractor_;
  FeatureSet found_;
};

class OpenCvFeatures : public FeatureCountingSubject {
 public:
  OpenCvFeatures(const BenchInput& input, Figure what, cv::Ptr<cv::Feature2D> algorithm)
      : FeatureCountingSubject(input, std::move(what)), algorithm_(std::move(algorithm)) {}

 private:
  void work(std::size_t index) override {
    algorithm_->detectAndCompute(frame(index).grey, cv::noArray(), keypoints_, descriptors_);
  }
  std::size_t found() const override { return keypoints_.size(); }

  cv::Ptr<cv::Feature2D> algorithm_;
  std::vector<cv::KeyPoint> keypoints_;
  cv::Mat descriptors_;
};

}  // namespace

std::unique_ptr<Subject> features_subject(const BenchInput& input) {
  Figure figure{.key = "features", .label = "features alone, 1000 strongest", .yardstick = "orb_1000"};
  if (input.frames.front().grey.size() == kGoalSize) figure.goal = 0.45;
  return std::make_unique<HeelFeatures>(input, figure);
}

std::unique_ptr<Subject> orb_subject(const BenchInput& input, const char* key, const char* label,
                                     int features) {
  return std::make_unique<OpenCvFeatures>(input, Figure{.key = key, .label = label},
                                          cv::ORB::create(features));
}

Subjects opencv_features_subjects(const BenchInput& input) {
  Subjects subjects;
  const auto add = [&](const char* key, const char* label, cv::Ptr<cv::Feature2D> algorithm) {
    subjects.push_back(
        std::make_unique<OpenCvFeatures>(input, Figure{.key = key, .label = label}, std::move(algorithm)));
  };
  subjects.push_back(orb_subject(input, "orb_1000", "cv::ORB(1000)", kOrbFeatures));
  add("akaze", "cv::AKAZE", cv::AKAZE::create());
  add("sift", "cv::SIFT", cv::SIFT::create());
  return subjects;
}

}  // namespace heel::evaluation
