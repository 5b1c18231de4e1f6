// Searching photographs for a calibration board: a chessboard or a grid of circles.
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace heel::cli {

enum class Pattern { Chessboard, Circles, AsymmetricCircles };

/// Inner corners of a chessboard, or circles: along a row and down a column; from one to the next, metres. In
/// an asymmetric grid every second row is moved by half of the distance between the circles of a row, which
/// is twice `square_m`.
struct Board {
  cv::Size corners;
  double square_m = 0.0;
  Pattern pattern = Pattern::Chessboard;
};

/// The board's points in its plane, in the order in which they are found.
std::vector<cv::Point3f> board_points(const Board& board);

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

/// What a finished search of one image found, for a line of progress.
struct SearchedImage {
  std::string image;
  bool found = false;
  std::size_t done = 0, images = 0;
  double left_s = 0.0;  ///< for the other images, by the time taken so far
};

/// Searches every image for the board, on all cores; `progress` is called in the order of the images. Throws
/// heel::Error when an image cannot be read or has another size, and when fewer than `least_views` show the
/// board: then it says what the board may have been mistaken for.
BoardViews find_board(const std::vector<std::string>& images, const Board& board, std::size_t least_views,
                      const std::function<void(const SearchedImage&)>& progress);

}  // namespace heel::cli
