// All that is measured, by kind. The input must outlive the subjects.
#pragma once

#include "evaluation/benchmarks/subject.h"

namespace heel::evaluation {

/// The size at which the goals and the cost models hold.
inline const cv::Size kGoalSize{640, 480};

/// The daemon's own vision: searching everywhere, and tracking.
class PipelineSubject : public Subject {
 public:
  using Subject::Subject;
  virtual double found_share() const = 0;
  virtual double tracked_share() const = 0;
  virtual std::uint32_t template_features() const = 0;
};
std::unique_ptr<PipelineSubject> search_subject(const BenchInput& input);
std::unique_ptr<PipelineSubject> tracking_subject(const BenchInput& input);

/// Searching for a small shirt in large pictures, and cv::ORB(3000) on them; keys search_1080p, orb_3000.
Subjects far_shirt_subjects(const BenchInput& input);

/// Features of a frame: heel's alone, then OpenCV's.
std::unique_ptr<Subject> features_subject(const BenchInput& input);
Subjects opencv_features_subjects(const BenchInput& input);
std::unique_ptr<Subject> orb_subject(const BenchInput& input, const char* key, const char* label,
                                     int features);

/// 300 × 1000 features matched; keys matcher, bf_matcher.
Subjects matcher_subjects(const BenchInput& input);

/// 200 pairs, half of them wrong; keys homography, decomposition, usac_magsac, decompose_homography_mat.
Subjects geometry_subjects();

}  // namespace heel::evaluation
