// Whether a chessboard has the markers of a ChArUco board. Which marker is which is not read: a part of a
// board calibrates wherever on the board it is.
#pragma once

#include "board_finder.h"

namespace heel::cli {

/// Whether the squares of one colour are not plain.
bool has_markers(const cv::Mat& grey, const FoundCorners& found);

}  // namespace heel::cli
