#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "evaluation/benchmarks/geometry_problem.h"
#include "evaluation/benchmarks/subjects.h"
#include "heel/homography.h"
#include "heel/motion.h"

namespace heel::evaluation {
namespace {

constexpr int kProblems = 64;
constexpr double kInlier_px = 3.0;
constexpr double kConfidence = 0.999;
constexpr int kMaxIterations = 10000;
constexpr int kDecompositionRepeats = 100;  // microseconds each: the clock's own cost must not count

using Problems = std::vector<GeometryProblem>;

/// The next problem with every frame.
class GeometrySubject : public Subject {
 public:
  GeometrySubject(std::shared_ptr<const Problems> problems, Figure what, int repeats = 1)
      : Subject(std::move(what), repeats), problems_(std::move(problems)) {}

 protected:
  const GeometryProblem& problem(std::size_t frame) const { return (*problems_)[frame % problems_->size()]; }

 private:
  std::shared_ptr<const Problems> problems_;
};

class HomographySubject : public GeometrySubject {
 public:
  using GeometrySubject::GeometrySubject;

 protected:
  /// A failure counts as infinitely far off.
  virtual bool solution(Eigen::Matrix3d& H) const = 0;

 private:
  bool settle(std::size_t frame) override {
    Eigen::Matrix3d H;
    errors_px_.push_back(solution(H) ? problem(frame).corner_error_px(H)
                                     : std::numeric_limits<double>::infinity());
    return true;
  }
  void complete(Figure& figure) const override {
    if (errors_px_.empty()) return;
    std::vector<double> sorted = errors_px_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    figure.corner_error_px = *middle;
  }

  std::vector<double> errors_px_;
};

class HeelHomography : public HomographySubject {
 public:
  HeelHomography(const std::shared_ptr<const Problems>& problems, Figure what)
      : HomographySubject(problems, std::move(what)),
        estimator_(static_cast<int>(problems->front().pairs.size()),
                   {.inlier_px = kInlier_px, .confidence = kConfidence, .max_iterations = kMaxIterations}) {
    mask_.reserve(problems->front().pairs.size());
  }

 private:
  void work(std::size_t frame) override { found_ = estimator_.estimate(problem(frame).pairs, mask_); }
  bool solution(Eigen::Matrix3d& H) const override {
    H = found_.H_cur_from_ref;
    return found_.status == HomographyStatus::Ok;
  }

  HomographyEstimator estimator_;
  std::vector<std::uint8_t> mask_;
  RobustHomography found_;
};

class OpenCvHomography : public HomographySubject {
 public:
  using HomographySubject::HomographySubject;

 private:
  void work(std::size_t frame) override {
    found_ = cv::findHomography(problem(frame).ref, problem(frame).cur, cv::USAC_MAGSAC, kInlier_px,
                                cv::noArray(), kMaxIterations, kConfidence);
  }
  bool solution(Eigen::Matrix3d& H) const override {
    if (found_.empty()) return false;
    for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = found_.at<double>(i / 3, i % 3);
    return true;
  }

  cv::Mat found_;
};

class HeelDecomposition : public GeometrySubject {
 public:
  using GeometrySubject::GeometrySubject;

 private:
  void work(std::size_t frame) override { motions_ = decompose_plane_motion(problem(frame).A_cur_from_ref); }

  PlaneMotions motions_;
};

class OpenCvDecomposition : public GeometrySubject {
 public:
  using GeometrySubject::GeometrySubject;

 private:
  void work(std::size_t frame) override {
    cv::Matx33d A;
    for (int i = 0; i < 9; ++i) A.val[i] = problem(frame).A_cur_from_ref(i / 3, i % 3);
    cv::decomposeHomographyMat(A, cv::Matx33d::eye(), R_, t_, n_);
  }

  std::vector<cv::Mat> R_, t_, n_;
};

}  // namespace

Subjects geometry_subjects() {
  auto problems = std::make_shared<Problems>();
  for (int i = 0; i < kProblems; ++i)
    problems->push_back(make_geometry_problem(static_cast<std::uint64_t>(i) + 1));
  Subjects subjects;
  subjects.push_back(
      std::make_unique<HeelHomography>(problems, Figure{.key = "homography",
                                                        .label = "homography, 200 pairs, half wrong",
                                                        .yardstick = "usac_magsac",
                                                        .goal = 1.0}));
  subjects.push_back(std::make_unique<HeelDecomposition>(
      problems,
      Figure{.key = "decomposition", .label = "decomposition", .yardstick = "decompose_homography_mat"},
      kDecompositionRepeats));
  subjects.push_back(std::make_unique<OpenCvHomography>(
      problems, Figure{.key = "usac_magsac", .label = "findHomography, USAC_MAGSAC"}));
  subjects.push_back(std::make_unique<OpenCvDecomposition>(
      problems, Figure{.key = "decompose_homography_mat", .label = "decomposeHomographyMat"},
      kDecompositionRepeats));
  return subjects;
}

}  // namespace heel::evaluation
