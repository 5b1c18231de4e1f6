// Still images as the operator's commands read them: 8-bit grey, by OpenCV's decoders.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace heel {

/// The image in grey, continuous. Throws heel::Error naming the file when it cannot be read or decoded.
cv::Mat read_grey_image(const std::string& path);

/// Throws heel::Error naming `path`'s extension unless OpenCV can write such images.
void require_writable_picture_name(const std::string& path);

/// Writes a picture; the extension says the format. Throws heel::Error naming the file.
void write_picture(const std::string& path, const cv::Mat& picture);

}  // namespace heel
