// Searching many photographs for a calibration board, on all cores.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "board_finder.h"

namespace heel::cli {

/// An image that shows the board, or a rectangle of its corners.
struct BoardView {
  std::string image;
  std::vector<cv::Point2f> corners_px;
  cv::Size seen;            ///< corners along a row and down a column; of a part, either way round
  bool has_markers = true;  ///< of a ChArUco board
  double rms_px = 0.0;      ///< reprojection error, set by the calibration
};

/// The view's points in the plane of the board, in the order of its corners. Those of a part start at its own
/// first corner: which part it is does not matter to a calibration.
std::vector<cv::Point3f> board_points(const Board& board, const BoardView& view);

struct BoardViews {
  std::vector<BoardView> views;
  std::vector<std::string> images_without_board;
  cv::Size image_size;
};

/// What a finished search of one image found, for a line of progress.
struct SearchedImage {
  std::string image;
  bool found = false;
  bool is_part = false;  ///< not the whole board
  std::size_t done = 0, images = 0;
  std::string missing{};  ///< GreyImage::missing
};

/// Searches every image for the board, on all cores. Of a chessboard a part of at least 4 x 4 corners is
/// taken as well, when two images or more show the whole of it: then its number of corners is right.
/// `progress` is called in the order of the images. Throws heel::Error when an image cannot be read or has
/// another size, and when fewer than `least_views` show the board: then it says what the board may have been
/// mistaken for; also when a board without markers was said to be a ChArUco board.
BoardViews find_board(const std::vector<std::string>& images, const Board& board, std::size_t least_views,
                      const std::function<void(const SearchedImage&)>& progress);

}  // namespace heel::cli
