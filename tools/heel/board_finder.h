// Searching one photograph for a calibration board: a chessboard, whole or in part, or a grid of circles.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace heel::cli {

enum class Pattern { Chessboard, Charuco, Circles, AsymmetricCircles };

/// Inner corners of a chessboard, or circles: along a row and down a column; from one to the next, metres. In
/// an asymmetric grid every second row is moved by half of the distance between the circles of a row, which
/// is twice `square_m`.
struct Board {
  cv::Size corners;
  double square_m = 0.0;
  Pattern pattern = Pattern::Chessboard;

  bool has_squares() const { return pattern == Pattern::Chessboard || pattern == Pattern::Charuco; }
};

struct FoundCorners {
  std::vector<cv::Point2f> corners_px;  ///< empty: no board
  cv::Size seen;                        ///< along a row and down a column; of a part, either way round
};

/// The board in a grey picture. Of a chessboard that is not seen as a whole, a part of at least 4 x 4
/// corners.
FoundCorners find_corners(const cv::Mat& grey, const Board& board);

/// Whether a small copy of the picture shows a whole chessboard with so many inner corners.
bool shows_chessboard_roughly(const cv::Mat& grey, cv::Size corners);

}  // namespace heel::cli
