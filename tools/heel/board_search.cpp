#include "board_search.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>
#include <utility>

#include "board_markers.h"
#include "files/image_file.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

constexpr std::size_t kLeastWholeViews = 2;  // show that the number of corners is right

/// How many of the images show this board; in a small copy, because it is a guess.
std::size_t images_that_show(const std::vector<std::string>& images, cv::Size board) {
  std::atomic<std::size_t> seen{0};
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < images.size(); i = next++) {
      if (shows_chessboard_roughly(decode_grey_image(images[i]).grey, board)) ++seen;
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
  if (!board.has_squares()) return "";
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

/// A picture that is blurred or far away may not show them.
void require_markers(const BoardViews& found) {
  const auto marked = static_cast<std::size_t>(std::count_if(
      found.views.begin(), found.views.end(), [](const BoardView& view) { return view.has_markers; }));
  if (2 * marked >= found.views.size()) return;
  throw Error(
      fmt::format("--pattern: 'charuco', but only {} of {} views of the board have markers in its white "
                  "squares (expected most of them; a board without markers is a chessboard)",
                  marked, found.views.size()));
}

/// Leaves the views of the whole board.
void drop_parts(BoardViews& found, const Board& board) {
  for (const BoardView& view : found.views)
    if (view.seen != board.corners) found.images_without_board.push_back(view.image);
  std::erase_if(found.views, [&](const BoardView& view) { return view.seen != board.corners; });
}

}  // namespace

std::vector<cv::Point3f> board_points(const Board& board, const BoardView& view) {
  std::vector<cv::Point3f> points_m;
  for (int row = 0; row < view.seen.height; ++row) {
    for (int column = 0; column < view.seen.width; ++column) {
      const int x = board.pattern == Pattern::AsymmetricCircles ? 2 * column + row % 2 : column;
      points_m.emplace_back(static_cast<float>(x * board.square_m), static_cast<float>(row * board.square_m),
                            0.f);
    }
  }
  return points_m;
}

BoardViews find_board(const std::vector<std::string>& images, const Board& board, std::size_t least_views,
                      const std::function<void(const SearchedImage&)>& progress) {
  BoardViews found;
  struct Searched {
    cv::Size size;
    FoundCorners found;
    bool has_markers = true;
    std::string missing{};
  };
  std::vector<std::promise<Searched>> promises(images.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < images.size(); i = next++) {
      try {
        const GreyImage image = read_grey_image(images[i]);
        const cv::Mat& grey = image.grey;
        FoundCorners corners = find_corners(grey, board);
        const bool markers = board.pattern != Pattern::Charuco || has_markers(grey, corners);
        promises[i].set_value({grey.size(), std::move(corners), markers, image.missing});
      } catch (...) {
        promises[i].set_exception(std::current_exception());
      }
    }
  };
  std::vector<std::future<Searched>> results;
  results.reserve(promises.size());
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
    const bool shows = !searched.found.corners_px.empty();
    const bool is_part = shows && searched.found.seen != board.corners;
    if (shows) {
      found.views.push_back(
          {images[i], std::move(searched.found.corners_px), searched.found.seen, searched.has_markers});
    } else {
      found.images_without_board.push_back(images[i]);
    }
    progress({images[i], shows, is_part, i + 1, images.size(), searched.missing});
  }
  const auto is_whole = [&](const BoardView& view) { return view.seen == board.corners; };
  const auto whole =
      static_cast<std::size_t>(std::count_if(found.views.begin(), found.views.end(), is_whole));
  const std::size_t with_parts = found.views.size();
  if (whole < kLeastWholeViews) drop_parts(found, board);
  if (found.views.size() < least_views) {
    std::string likely = mistaken_board(images, board, found.views.size());
    if (const std::size_t parts = with_parts - found.views.size(); likely.empty() && parts > 0)
      likely = fmt::format("; {} more show a part of it: does something cover it, or does light glare on it?",
                           parts);
    const std::string without_board =
        found.images_without_board.empty()
            ? ""
            : fmt::format("; not seen in {}", fmt::join(found.images_without_board, ", "));
    throw Error(fmt::format(
        "only {} of {} images show the {}x{} board (expected at least {}, two of them the whole of it){}{}",
        found.views.size(), images.size(), board.corners.width, board.corners.height, least_views, likely,
        without_board));
  }
  require_markers(found);
  return found;
}

}  // namespace heel::cli
