#include "camera_calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <optional>

#include "heel/error.h"
#include "vision/lens/lens_fold.h"

namespace heel::cli {
namespace {

constexpr double kMaxViewRms_px = 1.5;        // above: wrong corners, or a board that is not flat
constexpr double kMinTurn_deg = 20.0;         // parallel boards do not determine the focal length
constexpr double kMaxFocalSigmaShare = 0.02;  // above: the views do not determine the focal length
constexpr std::size_t kMaxParts = 10;         // of the views, for the jackknife
constexpr double kAsGood = 1.05;              // a reprojection error larger by less than this is as good
constexpr double kMinCornerSigma_px = 0.05;   // no camera sees corners better, whatever the residuals are
constexpr double kMaxSideError_cm = 30.0;     // above: refused
constexpr double kGoodSideError_cm = 10.0;    // above: a warning

double largest_turn_deg(const std::vector<cv::Mat>& rotations) {
  std::vector<cv::Vec3d> normals;
  for (const cv::Mat& rotation : rotations) {
    cv::Matx33d R;
    cv::Rodrigues(rotation, R);
    normals.push_back(R * cv::Vec3d(0, 0, 1));
  }
  double smallest_cosine = 1.0;
  for (const cv::Vec3d& a : normals) {
    for (const cv::Vec3d& b : normals) smallest_cosine = std::min(smallest_cosine, std::abs(a.dot(b)));
  }
  return std::acos(smallest_cosine) * 180.0 / CV_PI;
}

CameraModel camera_model(cv::Size image_size, const cv::Mat& K, const cv::Mat& distortion) {
  CameraModel camera;
  camera.width_px = image_size.width;
  camera.height_px = image_size.height;
  camera.fx = K.at<double>(0, 0);
  camera.fy = K.at<double>(1, 1);
  camera.cx = K.at<double>(0, 2);
  camera.cy = K.at<double>(1, 2);
  camera.k1 = distortion.at<double>(0);
  camera.k2 = distortion.at<double>(1);
  camera.p1 = distortion.at<double>(2);
  camera.p2 = distortion.at<double>(3);
  camera.k3 = distortion.at<double>(4);
  return camera;
}

void require_good_views(const std::vector<BoardView>& views) {
  std::vector<std::string> poor;
  for (const BoardView& view : views) {
    if (!(view.rms_px <= kMaxViewRms_px))
      poor.push_back(fmt::format("{} ({:.2f} px)", view.image, view.rms_px));
  }
  if (!poor.empty())
    throw Error(fmt::format("poor views, leave them out or take them again: {} (expected at most {:.1f} px)",
                            fmt::join(poor, ", "), kMaxViewRms_px));
}

/// The standard deviation that the solver states is not enough: with parallel boards it is small, and the
/// focal length is wrong.
void require_determined_focal_length(const Calibration& result) {
  constexpr const char* kNotDetermined = "the views do not determine the focal length: ";
  if (!(result.largest_turn_deg >= kMinTurn_deg))
    throw Error(fmt::format(
        "{}the board turns by at most {:.0f} degrees between them (expected {:.0f} or more; tilt it 30 to 45 "
        "degrees in several directions)",
        kNotDetermined, result.largest_turn_deg, kMinTurn_deg));
  const double share = std::max(result.fx_sigma_px / result.camera.fx, result.fy_sigma_px / result.camera.fy);
  if (!(share <= kMaxFocalSigmaShare))
    throw Error(
        fmt::format("{}known to {:.0f} % (expected {:.0f} % or better; take more views, with the board "
                    "larger in the image)",
                    kNotDetermined, 100.0 * share, 100.0 * kMaxFocalSigmaShare));
}

std::string what_to_add(const Calibration& calibration) {
  if (calibration.not_shown.empty())
    return "add views with the board at the edges and in the corners, tilted 30 to 45 degrees";
  return fmt::format(
      "no view shows the board in {} of the picture; add views with the board there, and tilted",
      calibration.not_shown);
}

void require_determined_edges(const Calibration& result) {
  if (const std::optional<double> fold_px = fold_in_picture_px(result.camera))
    throw Error(fmt::format(
        "the views do not determine the distortion: beyond {:.0f} px from the middle the result is no "
        "lens's; {}",
        *fold_px, what_to_add(result)));
  if (!(result.edges.side_cm <= kMaxSideError_cm))
    throw Error(fmt::format(
        "the views do not determine the edges of the picture: a person 3 m away may be {:.0f} cm from "
        "where they are seen there (expected at most {:.0f} cm); {}",
        result.edges.side_cm, kMaxSideError_cm, what_to_add(result)));
}

}  // namespace

namespace {

/// Calibrations each without one of at most kMaxParts parts of the views, from the whole one's result.
std::vector<CameraModel> calibrations_without_a_part(const std::vector<std::vector<cv::Point3f>>& points_m,
                                                     const std::vector<std::vector<cv::Point2f>>& corners_px,
                                                     cv::Size image_size, const cv::Mat& K,
                                                     const cv::Mat& distortion, bool with_k3) {
  const std::size_t parts = std::min(kMaxParts, corners_px.size());
  std::vector<CameraModel> cameras;
  for (std::size_t part = 0; part < parts; ++part) {
    std::vector<std::vector<cv::Point3f>> others_m;
    std::vector<std::vector<cv::Point2f>> others_px;
    for (std::size_t view = 0; view < corners_px.size(); ++view) {
      if (view % parts == part) continue;
      others_m.push_back(points_m[view]);
      others_px.push_back(corners_px[view]);
    }
    cv::Mat K_part = K.clone(), distortion_part = distortion.clone();
    std::vector<cv::Mat> rotations, translations;
    cv::calibrateCamera(others_m, others_px, image_size, K_part, distortion_part, rotations, translations,
                        cv::CALIB_USE_INTRINSIC_GUESS | (with_k3 ? 0 : cv::CALIB_FIX_K3));
    cameras.push_back(camera_model(image_size, K_part, distortion_part));
  }
  return cameras;
}

/// The camera without the last radial coefficient, if it explains the views nearly as well: then they do not
/// determine that coefficient.
std::optional<CameraModel> simpler_camera(const std::vector<std::vector<cv::Point3f>>& points_m,
                                          const std::vector<std::vector<cv::Point2f>>& corners_px,
                                          cv::Size image_size, bool with_k3, double rms_px) {
  cv::Mat K, distortion;
  std::vector<cv::Mat> rotations, translations;
  const int flags = cv::CALIB_FIX_K3 | (with_k3 ? 0 : cv::CALIB_FIX_K2);
  const double simpler_rms_px =
      cv::calibrateCamera(points_m, corners_px, image_size, K, distortion, rotations, translations, flags);
  if (simpler_rms_px > kAsGood * rms_px) return std::nullopt;
  return camera_model(image_size, K, distortion);
}

}  // namespace

Calibration calibrate_camera(const Board& board, cv::Size image_size, bool with_k3,
                             std::vector<BoardView>& views) {
  std::vector<std::vector<cv::Point2f>> corners_px;
  std::vector<std::vector<cv::Point3f>> points_m;
  for (const BoardView& view : views) {
    corners_px.push_back(view.corners_px);
    points_m.push_back(board_points(board, view));
  }

  cv::Mat K, distortion, intrinsic_sigmas, extrinsic_sigmas, view_rms_px;
  std::vector<cv::Mat> rotations, translations;
  Calibration result;
  result.rms_px =
      cv::calibrateCamera(points_m, corners_px, image_size, K, distortion, rotations, translations,
                          intrinsic_sigmas, extrinsic_sigmas, view_rms_px, with_k3 ? 0 : cv::CALIB_FIX_K3);
  for (std::size_t i = 0; i < views.size(); ++i)
    views[i].rms_px = view_rms_px.at<double>(static_cast<int>(i));
  result.largest_turn_deg = largest_turn_deg(rotations);
  result.fx_sigma_px = intrinsic_sigmas.at<double>(0);
  result.fy_sigma_px = intrinsic_sigmas.at<double>(1);
  result.camera = camera_model(image_size, K, distortion);
  const double sigma_px = std::max(result.rms_px, kMinCornerSigma_px);
  result.edges = edge_errors(
      result.camera, cameras_within_95(result.camera, with_k3, sigma_px, points_m, rotations, translations),
      calibrations_without_a_part(points_m, corners_px, image_size, K, distortion, with_k3),
      simpler_camera(points_m, corners_px, image_size, with_k3, result.rms_px));
  result.not_shown = parts_not_shown(image_size, corners_px);
  for (std::size_t i = 0; i < 3; ++i)
    result.radial_sigma[i] = intrinsic_sigmas.at<double>(i < 2 ? 4 + static_cast<int>(i) : 8);
  return result;
}

void require_good_calibration(const std::vector<BoardView>& views, const Calibration& calibration) {
  require_good_views(views);
  require_determined_focal_length(calibration);
  require_determined_edges(calibration);
}

std::string warning_of(const Calibration& calibration) {
  const EdgeErrors& edges = calibration.edges;
  if (edges.side_cm > kGoodSideError_cm || edges.corner_cm > kMaxSideError_cm)
    return fmt::format(
        "a person 3 m away at the edge of the picture may be {:.0f} cm from where they are seen, in the "
        "corners {:.0f} cm; {}",
        edges.side_cm, edges.corner_cm, what_to_add(calibration));
  if (!calibration.not_shown.empty())
    return fmt::format("no view shows the board in {} of the picture; add views with the board there",
                       calibration.not_shown);
  return "";
}

std::string warnings_of(const Calibration& calibration) {
  const std::string lacks = warning_of(calibration), unusual = unusual_values(calibration.camera);
  return lacks + (lacks.empty() || unusual.empty() ? "" : "; ") + unusual;
}

}  // namespace heel::cli
