// Still images in and out: 8-bit grey, by OpenCV's decoders and encoders.
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

/// The images in a folder, in natural order (2 before 10), without those in its subfolders. `error` says why
/// the folder could not be read.
std::vector<std::string> images_in_folder(const std::string& folder, std::error_code& error);

/// The image in grey, one block of memory; empty when it cannot be decoded. A rotation noted in the file
/// (EXIF) is ignored, because the camera's calibration does not have it.
cv::Mat decode_grey_image(const std::string& path);
/// As decode_grey_image, for commands: throws heel::Error naming the file, and keeps the decoders' own
/// messages from stderr, which for that time is closed to the whole process.
cv::Mat read_grey_image(const std::string& path);

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
