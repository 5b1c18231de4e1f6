// Camera calibration from views of a chessboard, and the checks that its result can be trusted.
//
// Z. Zhang, "A Flexible New Technique for Camera Calibration", PAMI 2000, as OpenCV implements it.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "heel/camera_model.h"

namespace heel::cli {

/// A chessboard: inner corners along a row and down a column, side of one square.
struct Board {
  cv::Size corners;
  double square_m = 0.0;
};

/// An image that shows the whole board.
struct BoardView {
  std::string image;
  std::vector<cv::Point2f> corners_px;
  double rms_px = 0.0;  ///< reprojection error, set by the calibration
};

struct BoardViews {
  std::vector<BoardView> views;
  std::vector<std::string> images_without_board;
  cv::Size image_size;
};

struct Calibration {
  CameraModel camera;
  double rms_px = 0.0;
  double fx_sigma_px = 0.0;
  double fy_sigma_px = 0.0;
  double largest_turn_deg = 0.0;  ///< the largest angle between the boards of two views
};

/// Searches every image for the board. Throws heel::Error when an image cannot be read or has another size,
/// and when too few of them show the board.
BoardViews find_board(const std::vector<std::string>& images, const Board& board);

/// `with_k3`: also estimates the third radial coefficient. Sets the views' errors.
Calibration calibrate_camera(const Board& board, cv::Size image_size, bool with_k3,
                             std::vector<BoardView>& views);

/// Throws heel::Error naming the views whose error is too large, or saying that the views do not determine
/// the focal length.
void require_good_calibration(const std::vector<BoardView>& views, const Calibration& calibration);

}  // namespace heel::cli
