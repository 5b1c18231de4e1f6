// How the stored rows of a picture or video become the picture that is shown: EXIF's numbers 1 to 8. Every
// reader of heel gives the picture as it is shown.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

#include "core/picture_turn.h"

namespace heel {

inline constexpr int kAsStored = 1;

/// An 8-bit picture, turned, in one block of memory; the picture itself where there is nothing to turn.
cv::Mat turned_picture(const cv::Mat& grey, const PictureTurn& turn);

/// An 8-bit picture as it is shown. `orientation` as in EXIF: 2 mirrored, 3 turned by 180°, 4 upside down and
/// mirrored, 5 transposed, 6 turned by 90° clockwise, 7 transposed and turned by 180°, 8 turned by 90°
/// counterclockwise. Any other number: as stored.
cv::Mat shown_picture(const cv::Mat& stored, int orientation);

/// The orientation that a video's display matrix means (a, b, u, c, d, v, x, y, w in 16.16 and 2.30 fixed
/// point: x' = a x + c y, y' = b x + d y); 0 when it is none of the eight.
int orientation_of_display_matrix(std::span<const std::int32_t, 9> matrix);

}  // namespace heel
