#include "evaluation/experiments/planar_matching.h"

#include <cmath>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace heel::evaluation {
namespace {

constexpr double kAkazeThreshold = 2e-4;  // a fifth of OpenCV's: it finds far more of the backs with it
constexpr float kRatio = 0.8F;
constexpr double kInlier_px = 3.0;
constexpr std::size_t kMinPairs = 4;
constexpr std::uint32_t kMinInliers = 8;  // as heel's
constexpr int kMaxIterations = 5000;      // as heel's
constexpr double kConfidence = 0.999;

struct Detector {
  cv::Ptr<cv::Feature2D> features;
  cv::NormTypes norm = cv::NORM_L2;
  double enlarged = 1.0;  ///< the picture is enlarged by this before
};

struct Described {
  std::vector<cv::KeyPoint> points;  ///< places in the picture as it was taken
  cv::Mat descriptors;
};

Described describe(const Detector& detector, const cv::Mat& grey, const cv::Mat& mask) {
  cv::Mat picture = grey, part = mask;
  if (detector.enlarged != 1.0) {
    cv::resize(grey, picture, {}, detector.enlarged, detector.enlarged, cv::INTER_LINEAR);
    if (!mask.empty()) cv::resize(mask, part, picture.size(), 0, 0, cv::INTER_NEAREST);
  }
  Described found;
  detector.features->detectAndCompute(picture, part, found.points, found.descriptors);
  const auto shift = static_cast<float>(0.5 / detector.enlarged - 0.5);  // pixel centres of both pictures
  for (cv::KeyPoint& point : found.points)
    point.pt = point.pt / static_cast<float>(detector.enlarged) + cv::Point2f(shift, shift);
  return found;
}

cv::Matx33d matrix_of(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

class PlanarMatcher {
 public:
  PlanarMatcher(Detector detector, const ShirtTemplate& shirt, const CameraModel& camera)
      : detector_(std::move(detector)),
        K_(matrix_of(camera.K())),
        distance_m_(shirt.distance_m),
        centre_ref_px_(shirt.roi.x_px + 0.5 * (shirt.roi.width_px - 1),
                       shirt.roi.y_px + 0.5 * (shirt.roi.height_px - 1)) {
    const cv::Mat view(shirt.camera.height_px, shirt.camera.width_px, CV_8U,
                       const_cast<std::uint8_t*>(shirt.grey.data()));
    cv::Mat mask(view.size(), CV_8U, cv::Scalar(0));
    mask(cv::Rect(shirt.roi.x_px, shirt.roi.y_px, shirt.roi.width_px, shirt.roi.height_px)) = 255;
    template_ = describe(detector_, view, mask);
  }

  ForeignAnswer estimate(const cv::Mat& grey) const;

 private:
  struct Pairs {
    std::vector<cv::Point2d> ref_px, cur_px;
  };
  Pairs match(const Described& frame) const;
  ForeignAnswer decompose(const cv::Mat& H_cur_from_ref, ForeignAnswer answer) const;

  Detector detector_;
  cv::Matx33d K_;
  double distance_m_;
  cv::Point2d centre_ref_px_;
  Described template_;
};

PlanarMatcher::Pairs PlanarMatcher::match(const Described& frame) const {
  std::vector<std::vector<cv::DMatch>> nearest;
  if (frame.points.size() >= 2 && !template_.points.empty())
    cv::BFMatcher(detector_.norm).knnMatch(template_.descriptors, frame.descriptors, nearest, 2);
  Pairs pairs;
  for (const auto& two : nearest) {
    if (two.size() < 2 || two[0].distance > kRatio * two[1].distance) continue;
    pairs.ref_px.emplace_back(template_.points[static_cast<std::size_t>(two[0].queryIdx)].pt);
    pairs.cur_px.emplace_back(frame.points[static_cast<std::size_t>(two[0].trainIdx)].pt);
  }
  return pairs;
}

ForeignAnswer PlanarMatcher::estimate(const cv::Mat& grey) const {
  ForeignAnswer answer;
  const Pairs pairs = match(describe(detector_, grey, {}));
  answer.reason = "too few matches";
  if (pairs.ref_px.size() < kMinPairs) return answer;
  cv::Mat inliers;
  const cv::Mat H = cv::findHomography(pairs.ref_px, pairs.cur_px, cv::USAC_MAGSAC, kInlier_px, inliers,
                                       kMaxIterations, kConfidence);
  answer.reason = "no homography";
  if (H.empty()) return answer;
  answer.inliers = static_cast<std::uint32_t>(cv::countNonZero(inliers));
  answer.certainty = static_cast<double>(answer.inliers) / static_cast<double>(template_.points.size());
  answer.reason = "too few inliers";
  if (answer.inliers < kMinInliers) return answer;
  return decompose(H, answer);
}

/// Of the solutions in which the template is in front of the camera, the one whose plane is nearest to that
/// of the reference view, z = d.
ForeignAnswer PlanarMatcher::decompose(const cv::Mat& H_cur_from_ref, ForeignAnswer answer) const {
  std::vector<cv::Mat> rotations, translations, normals;
  cv::decomposeHomographyMat(H_cur_from_ref, K_, rotations, translations, normals);
  const cv::Vec3d centre_ref = K_.inv() * cv::Vec3d(centre_ref_px_.x, centre_ref_px_.y, 1.0);  // times d
  double best = 0.0;
  answer.reason = "no valid motion";
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const cv::Matx33d R(rotations[i]);
    const cv::Vec3d t_over_d(translations[i]), normal(normals[i]);
    const cv::Vec3d centre_cur = R * centre_ref + t_over_d;
    if (normal[2] <= best || centre_cur[2] <= 0.0) continue;
    best = normal[2];
    answer.found = true;
    answer.yaw_rad = std::atan2(R(0, 2), R(2, 2));
    answer.position_m = distance_m_ * Eigen::Vector3d(centre_cur[0], centre_cur[1], centre_cur[2]);
  }
  if (answer.found) answer.reason = "found";
  return answer;
}

ForeignMethod planar_method(const std::string& name, Detector (*detector)()) {
  return {name, [detector](const ShirtTemplate& shirt, const CameraModel& camera, bool /*in_sequence*/) {
            const auto matcher = std::make_shared<PlanarMatcher>(detector(), shirt, camera);
            return [matcher](const cv::Mat& grey, double /*t_s*/) { return matcher->estimate(grey); };
          }};
}

}  // namespace

std::vector<ForeignMethod> planar_methods() {
  return {
      planar_method("ORB(3000)",
                    [] {
                      return Detector{cv::ORB::create(3000), cv::NORM_HAMMING};
                    }),
      planar_method("SIFT", [] { return Detector{cv::SIFT::create()}; }),
      planar_method("SIFT on the picture enlarged by two",
                    [] {
                      return Detector{cv::SIFT::create(), cv::NORM_L2, 2.0};
                    }),
      planar_method("AKAZE",
                    [] {
                      const cv::Ptr<cv::AKAZE> akaze = cv::AKAZE::create();
                      akaze->setThreshold(kAkazeThreshold);
                      return Detector{akaze, cv::NORM_HAMMING};
                    }),
  };
}

}  // namespace heel::evaluation
