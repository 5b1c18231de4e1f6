#include "board_search.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "files/image_file.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

// The search takes time as the picture has pixels: it is done in a picture of this width or height at most,
// and the corners that it finds are refined in the whole picture.
constexpr int kMaxSearched_px = 1280;
constexpr int kMaxOldSearched_px = 800;
constexpr int kRefinedWindow_px = 5;

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

std::vector<cv::Point2f> find_points(const cv::Mat& grey, const Board& board) {
  return board.pattern == Pattern::Chessboard ? find_chessboard(grey, board.corners)
                                              : find_circles(grey, board);
}

/// How many of the images show this board; in a small copy, because it is a guess.
std::size_t images_that_show(const std::vector<std::string>& images, cv::Size board) {
  std::atomic<std::size_t> seen{0};
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < images.size(); i = next++) {
      double scale = 1.0;
      const cv::Mat small = at_most(decode_grey_image(images[i]).grey, kMaxOldSearched_px, scale);
      if (!small.empty() && !search_chessboard(small, board).empty()) ++seen;
    }
  };
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
    workers.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : workers) worker.get();
  return seen;
}

/// Another count of corners that more images show: people count the squares.
std::string mistaken_board(const std::vector<std::string>& images, const Board& board, std::size_t found) {
  if (board.pattern != Pattern::Chessboard) return "";
  for (const cv::Size& other : {cv::Size(board.corners.width - 1, board.corners.height - 1),
                                cv::Size(board.corners.width + 1, board.corners.height + 1)}) {
    if (other.width < 3 || other.height < 3) continue;
    const std::size_t seen = images_that_show(images, other);
    if (seen > found)
      return fmt::format("; --board counts inner corners, where four squares meet; {}x{} is seen in {} of {}",
                         other.width, other.height, seen, images.size());
  }
  return "";
}

}  // namespace

std::vector<cv::Point3f> board_points(const Board& board) {
  std::vector<cv::Point3f> points_m;
  for (int row = 0; row < board.corners.height; ++row) {
    for (int column = 0; column < board.corners.width; ++column) {
      const int x = board.pattern == Pattern::AsymmetricCircles ? 2 * column + row % 2 : column;
      points_m.emplace_back(static_cast<float>(x * board.square_m), static_cast<float>(row * board.square_m),
                            0.f);
    }
  }
  return points_m;
}

BoardViews find_board(const std::vector<std::string>& images, const Board& board, std::size_t least_views,
                      const std::function<void(const SearchedImage&)>& progress) {
  const auto start = std::chrono::steady_clock::now();
  BoardViews found;
  struct Searched {
    cv::Size size;
    std::vector<cv::Point2f> points_px;
  };
  std::vector<std::promise<Searched>> promises(images.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < images.size(); i = next++) {
      try {
        const cv::Mat grey = read_grey_image(images[i]).grey;
        promises[i].set_value({grey.size(), find_points(grey, board)});
      } catch (...) {
        promises[i].set_exception(std::current_exception());
      }
    }
  };
  std::vector<std::future<Searched>> results;
  for (std::promise<Searched>& promise : promises) results.push_back(promise.get_future());
  std::vector<std::future<void>> workers;  // destroyed first: their destructors wait
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
    workers.push_back(std::async(std::launch::async, work));

  for (std::size_t i = 0; i < images.size(); ++i) {
    Searched searched;
    try {
      searched = results[i].get();
    } catch (...) {
      next = images.size();  // the others need not be searched
      throw;
    }
    if (found.image_size.empty()) found.image_size = searched.size;
    if (searched.size != found.image_size) {
      next = images.size();
      throw Error(fmt::format("{}: {}x{} pixels (expected {}x{} as in {})", images[i], searched.size.width,
                              searched.size.height, found.image_size.width, found.image_size.height,
                              images.front()));
    }
    const bool shows = !searched.points_px.empty();
    if (shows) {
      found.views.push_back({images[i], std::move(searched.points_px)});
    } else {
      found.images_without_board.push_back(images[i]);
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const double left = static_cast<double>(images.size() - i - 1) / static_cast<double>(i + 1);
    progress({images[i], shows, i + 1, images.size(), elapsed.count() * left});
  }
  if (found.views.size() < least_views) {
    const std::string without_board =
        found.images_without_board.empty()
            ? ""
            : fmt::format("; not seen in {}", fmt::join(found.images_without_board, ", "));
    throw Error(fmt::format("only {} of {} images show the whole {}x{} board (expected at least {}){}{}",
                            found.views.size(), images.size(), board.corners.width, board.corners.height,
                            least_views, mistaken_board(images, board, found.views.size()), without_board));
  }
  return found;
}

}  // namespace heel::cli
