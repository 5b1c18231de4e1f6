#include "camera_calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "files/image_file.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

constexpr std::size_t kMinViews = 5;
constexpr double kMaxViewRms_px = 1.5;        // above: wrong corners, or a board that is not flat
constexpr double kMinTurn_deg = 20.0;         // parallel boards do not determine the focal length
constexpr double kMaxFocalSigmaShare = 0.02;  // above: the views do not determine the focal length

std::vector<cv::Point2f> find_corners(const cv::Mat& grey, cv::Size board) {
  std::vector<cv::Point2f> corners_px;
  if (cv::findChessboardCornersSB(grey, board, corners_px, cv::CALIB_CB_ACCURACY)) return corners_px;
  // The older search finds boards with a narrow white margin, which the newer one does not.
  if (cv::findChessboardCorners(grey, board, corners_px)) {
    const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-3);
    cv::cornerSubPix(grey, corners_px, {5, 5}, {-1, -1}, stop);
    return corners_px;
  }
  return {};
}

std::vector<cv::Point3f> board_points(const Board& board) {
  std::vector<cv::Point3f> points_m;
  for (int row = 0; row < board.corners.height; ++row) {
    for (int column = 0; column < board.corners.width; ++column) {
      points_m.emplace_back(static_cast<float>(column * board.square_m),
                            static_cast<float>(row * board.square_m), 0.f);
    }
  }
  return points_m;
}

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

}  // namespace

BoardViews find_board(const std::vector<std::string>& images, const Board& board) {
  BoardViews found;
  for (const std::string& image : images) {
    const cv::Mat grey = read_grey_image(image).grey;
    if (found.image_size.empty()) found.image_size = grey.size();
    if (grey.size() != found.image_size)
      throw Error(fmt::format("{}: {}x{} pixels (expected {}x{} as in {})", image, grey.cols, grey.rows,
                              found.image_size.width, found.image_size.height, images.front()));
    BoardView view{image, find_corners(grey, board.corners)};
    if (view.corners_px.empty()) {
      found.images_without_board.push_back(image);
    } else {
      found.views.push_back(std::move(view));
    }
  }
  if (found.views.size() < kMinViews) {
    const std::string without_board =
        found.images_without_board.empty()
            ? ""
            : fmt::format("; not seen in {}", fmt::join(found.images_without_board, ", "));
    throw Error(fmt::format("only {} of {} images show the whole {}x{} board (expected at least {}){}",
                            found.views.size(), images.size(), board.corners.width, board.corners.height,
                            kMinViews, without_board));
  }
  return found;
}

Calibration calibrate_camera(const Board& board, cv::Size image_size, bool with_k3,
                             std::vector<BoardView>& views) {
  std::vector<std::vector<cv::Point2f>> corners_px;
  corners_px.reserve(views.size());
  for (const BoardView& view : views) corners_px.push_back(view.corners_px);
  const std::vector<std::vector<cv::Point3f>> points_m(views.size(), board_points(board));

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
  return result;
}

void require_good_calibration(const std::vector<BoardView>& views, const Calibration& calibration) {
  require_good_views(views);
  require_determined_focal_length(calibration);
}

}  // namespace heel::cli
