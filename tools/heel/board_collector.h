// Views of a calibration board from a live camera: which are worth keeping, and which parts of the picture
// they cover.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "board_finder.h"
#include "board_search.h"

namespace heel::cli {

enum class BoardSeen {
  None,    ///< no board
  Moving,  ///< it is elsewhere than in the frame before: the picture may be blurred
  Known,   ///< held still, and as in a view that is there
  Kept,    ///< a new view
};

class BoardCollector {
 public:
  explicit BoardCollector(const Board& board) : board_(board) {}

  /// Searches a frame; all must have one size.
  BoardSeen add(const cv::Mat& grey);

  const std::vector<BoardView>& views() const { return views_; }
  cv::Size image_size() const { return image_size_; }

  /// 3 rows of 3 parts of the picture as it is sent: 255 where a view has shown a corner, else 0.
  const cv::Mat& covered() const { return covered_; }

 private:
  bool is_still(const BoardView& view) const;
  bool is_known(const BoardView& view) const;
  void keep(const BoardView& view);

  Board board_;
  cv::Size image_size_;
  BoardView last_;
  std::vector<BoardView> views_;
  std::size_t whole_views_ = 0;
  cv::Mat covered_ = cv::Mat::zeros(3, 3, CV_8UC1);
};

/// Three lines: # where the board has been, . where not. `covered`: turned as the picture is shown.
std::vector<std::string> coverage_lines(const cv::Mat& covered);
/// The parts where it has not been: "upper left, right"; empty: none.
std::string parts_not_covered(const cv::Mat& covered);

}  // namespace heel::cli
