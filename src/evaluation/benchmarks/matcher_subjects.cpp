#include <algorithm>
#include <opencv2/features2d.hpp>
#include <utility>

#include "evaluation/benchmarks/subjects.h"
#include "heel/matching.h"

namespace heel::evaluation {
namespace {

constexpr int kRefs = 300;         // of a template
constexpr int kCurs = 1000;        // of a frame
constexpr float kAnyBlob = 1e-6f;  // threshold: plain pictures, too, are to give as many features

FeatureSet strongest(const BenchFrame& frame, int count) {
  FeatureExtractor extractor(frame.grey.cols, frame.grey.rows,
                             {.max_features = count, .threshold = kAnyBlob});
  FeatureSet features;
  extractor.extract(frame.view(0), features);
  return features;
}

class HeelMatcher : public Subject {
 public:
  HeelMatcher(FeatureSet ref, FeatureSet cur, Figure what)
      : Subject(std::move(what)), ref_(std::move(ref)), cur_(std::move(cur)), matcher_(kRefs, kCurs, {}) {
    matches_.reserve(kRefs);
  }

 private:
  void work(std::size_t /*frame*/) override { matcher_.match(ref_, cur_, matches_); }

  FeatureSet ref_, cur_;
  Matcher matcher_;
  std::vector<Match> matches_;
};

class OpenCvMatcher : public Subject {
 public:
  OpenCvMatcher(const FeatureSet& ref, const FeatureSet& cur, Figure what)
      : Subject(std::move(what)), ref_(rows_of(ref)), cur_(rows_of(cur)), matcher_(cv::NORM_L2) {}

 private:
  static cv::Mat rows_of(const FeatureSet& set) {
    cv::Mat rows(static_cast<int>(set.descriptors.size()), kDescriptorSize, CV_32F);
    for (int i = 0; i < rows.rows; ++i)
      std::copy_n(set.descriptors[static_cast<std::size_t>(i)].data(), kDescriptorSize, rows.ptr<float>(i));
    return rows;
  }
  void work(std::size_t /*frame*/) override { matcher_.knnMatch(ref_, cur_, matches_, 2); }

  cv::Mat ref_, cur_;
  cv::BFMatcher matcher_;
  std::vector<std::vector<cv::DMatch>> matches_;
};

}  // namespace

Subjects matcher_subjects(const BenchInput& input) {
  const FeatureSet ref = strongest(input.frames.front(), kRefs);
  const FeatureSet cur = strongest(input.frames.back(), kCurs);
  const std::string sizes = std::to_string(ref.features.size()) + " x " + std::to_string(cur.features.size());
  Subjects subjects;
  subjects.push_back(std::make_unique<HeelMatcher>(
      ref, cur,
      Figure{.key = "matcher", .label = "matcher, " + sizes, .yardstick = "bf_matcher", .goal = 0.1}));
  subjects.push_back(std::make_unique<OpenCvMatcher>(
      ref, cur, Figure{.key = "bf_matcher", .label = "cv::BFMatcher, " + sizes + ", knn 2"}));
  return subjects;
}

}  // namespace heel::evaluation
