// Still images in and out: 8-bit grey.
//
// One rule for every reader: a picture is turned as its file says that it is shown (EXIF), its grey values
// fill the 8 bits by the depth that they really have, and a damaged or cut file is no picture.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "heel/flow.h"

namespace heel {

/// Whether the file's name has the ending of an image (.png, .jpg …) or its first bytes are those of one.
bool is_image_file(const std::string& path);

struct FolderImages {
  std::vector<std::string> images;  ///< in natural order (2 before 10)
  std::vector<std::string>
      videos;  ///< the names of those beside them, which a folder of images does not show

  /// One line about the videos; empty without any.
  std::string passed_over() const;
};
/// The images in a folder, without those in its subfolders. `error` says why the folder could not be read.
FolderImages images_in_folder(const std::string& folder, std::error_code& error);

struct GreyImage {
  cv::Mat grey;         ///< one block of memory; empty when there is no whole picture
  std::string problem;  ///< then: why, with what was expected, without the file's name
  std::string note;     ///< what was taken for the depth of the pixels, where that is not plain
  std::string missing;  ///< what the file lacks, where the picture is whole without it
  int white = 255;      ///< the value in the file that became 255
};

/// Nothing is written to standard error, and nothing is thrown. `least_white`: of the pictures before it in a
/// sequence, so that a dark one is not made brighter than they are.
GreyImage decode_grey_image(const std::string& path, int least_white = 0);
/// As decode_grey_image, for commands: throws heel::Error naming the file.
GreyImage read_grey_image(const std::string& path, int least_white = 0);

/// The image as a frame without time and number; valid as long as `grey` is.
FrameView frame_view_of(const cv::Mat& grey);

/// Throws heel::Error naming `path` unless OpenCV can write images with its ending.
void require_writable_image_name(const std::string& path);

/// Writes an image in the format of the name's ending. Throws heel::Error naming the file.
void write_image(const std::string& path, const cv::Mat& image);
/// As write_image, of grey pixels with `stride_bytes` from one row to the next (0: the width).
void write_grey_image(const std::string& path, const std::uint8_t* grey, int width_px, int height_px,
                      std::size_t stride_bytes = 0);

}  // namespace heel
