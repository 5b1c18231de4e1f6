#include "board_finder.h"

#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace heel::cli {
namespace {

// The search takes time as the picture has pixels: it is done in a picture of this width or height at most,
// and the corners that it finds are refined in the whole picture.
constexpr int kMaxSearched_px = 1280;
constexpr int kMaxOldSearched_px = 800;
constexpr int kRefinedWindow_px = 5;
constexpr int kLeastPart = 4;       // corners along each side of a part of a chessboard
constexpr double kMostBent = 0.15;  // of the side of a square: how far lens and print bend a part

std::vector<cv::Point2f> search_chessboard(const cv::Mat& grey, cv::Size board) {
  std::vector<cv::Point2f> corners_px;
  if (cv::findChessboardCornersSB(grey, board, corners_px, cv::CALIB_CB_ACCURACY)) return corners_px;
  return {};
}

/// Refines corners found in a picture made smaller by `scale`.
void refine(const cv::Mat& grey, double scale, std::vector<cv::Point2f>& corners_px) {
  const float shift = static_cast<float>(0.5 * scale - 0.5);  // pixel (0,0) is the centre of a pixel
  for (cv::Point2f& corner : corners_px)
    corner = corner * static_cast<float>(scale) + cv::Point2f(shift, shift);
  const int window_px = std::max(kRefinedWindow_px, static_cast<int>(2.0 * scale));
  const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-3);
  cv::cornerSubPix(grey, corners_px, {window_px, window_px}, {-1, -1}, stop);
}

/// The picture, not wider or higher than `most_px`; and by how much it has been made smaller.
cv::Mat at_most(const cv::Mat& grey, int most_px, double& scale) {
  scale = std::max(1.0, static_cast<double>(std::max(grey.cols, grey.rows)) / most_px);
  if (scale == 1.0) return grey;
  cv::Mat small;
  cv::resize(grey, small, {}, 1.0 / scale, 1.0 / scale, cv::INTER_AREA);
  return small;
}

std::vector<cv::Point2f> find_chessboard(const cv::Mat& grey, cv::Size board) {
  double scale = 1.0;
  std::vector<cv::Point2f> corners_px = search_chessboard(at_most(grey, kMaxSearched_px, scale), board);
  if (!corners_px.empty()) {
    if (scale > 1.0) refine(grey, scale, corners_px);
    return corners_px;
  }
  // The older search finds boards with a narrow white margin, which the newer one does not. Without its quick
  // check it takes minutes in a dark or noisy picture.
  const cv::Mat searched = at_most(grey, kMaxOldSearched_px, scale);
  if (!cv::findChessboardCorners(
          searched, board, corners_px,
          cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK))
    return {};
  refine(grey, scale, corners_px);
  return corners_px;
}

/// How far the corners are from a plane's picture of them, against the distance of neighbours. Wrong rows
/// that were found beyond the edge of a board are far from it.
double bend(const std::vector<cv::Point2f>& corners_px, cv::Size seen) {
  std::vector<cv::Point2f> plane, shown;
  for (int row = 0; row < seen.height; ++row)
    for (int column = 0; column < seen.width; ++column)
      plane.emplace_back(static_cast<float>(column), static_cast<float>(row));
  const cv::Mat H = cv::findHomography(plane, corners_px);
  if (H.empty()) return std::numeric_limits<double>::infinity();
  cv::perspectiveTransform(plane, shown, H);
  double worst = 0.0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::size_t next = i % static_cast<std::size_t>(seen.width) == 0 ? i + 1 : i - 1;
    worst = std::max(worst, cv::norm(shown[i] - corners_px[i]) / cv::norm(shown[i] - shown[next]));
  }
  return worst;
}

/// A rectangle of corners of a chessboard that is not seen as a whole.
FoundCorners find_part(const cv::Mat& grey, cv::Size board) {
  double scale = 1.0;
  const cv::Mat searched = at_most(grey, kMaxSearched_px, scale);
  FoundCorners part;
  cv::Mat kinds;  // of its squares; its size is that of the part
  if (!cv::findChessboardCornersSB(searched, {kLeastPart, kLeastPart}, part.corners_px,
                                   cv::CALIB_CB_LARGER | cv::CALIB_CB_ACCURACY, kinds))
    return {};
  part.seen = kinds.size();
  const int longer = std::max(part.seen.width, part.seen.height),
            shorter = std::min(part.seen.width, part.seen.height);
  if (longer > std::max(board.width, board.height) || shorter > std::min(board.width, board.height))
    return {};
  if (bend(part.corners_px, part.seen) > kMostBent) return {};
  if (scale > 1.0) refine(grey, scale, part.corners_px);
  return part;
}

std::vector<cv::Point2f> find_circles(const cv::Mat& grey, const Board& board) {
  const int kind =
      board.pattern == Pattern::Circles ? cv::CALIB_CB_SYMMETRIC_GRID : cv::CALIB_CB_ASYMMETRIC_GRID;
  double scale = 1.0;
  const cv::Mat searched = at_most(grey, kMaxSearched_px, scale);
  // The detector of spots takes spots of up to 5000 pixels only, unless it is told otherwise.
  cv::SimpleBlobDetector::Params spots;
  spots.maxArea = static_cast<float>(searched.total()) / 20.f;
  spots.minArea = 10.f;
  std::vector<cv::Point2f> centres_px;
  if (!cv::findCirclesGrid(searched, board.corners, centres_px, kind, cv::SimpleBlobDetector::create(spots)))
    return {};
  const float shift = static_cast<float>(0.5 * scale - 0.5);
  for (cv::Point2f& centre : centres_px)
    centre = centre * static_cast<float>(scale) + cv::Point2f(shift, shift);
  return centres_px;
}

}  // namespace

FoundCorners find_corners(const cv::Mat& grey, const Board& board) {
  const bool chessboard = board.has_squares();
  FoundCorners found{chessboard ? find_chessboard(grey, board.corners) : find_circles(grey, board),
                     board.corners};
  return found.corners_px.empty() && chessboard ? find_part(grey, board.corners) : found;
}

bool shows_chessboard_roughly(const cv::Mat& grey, cv::Size corners) {
  double scale = 1.0;
  return !grey.empty() && !search_chessboard(at_most(grey, kMaxOldSearched_px, scale), corners).empty();
}

}  // namespace heel::cli
