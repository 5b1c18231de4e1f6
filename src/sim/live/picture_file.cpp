#include "sim/live/picture_file.h"

#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>

#include "heel/error.h"

namespace heel::sim {

void write_grey_picture(const std::string& path, const std::vector<std::uint8_t>& grey, int width_px,
                        int height_px) {
  // OpenCV wants a mutable pointer; it only reads.
  const cv::Mat picture(height_px, width_px, CV_8U, const_cast<std::uint8_t*>(grey.data()));
  bool written = false;
  try {
    written = cv::imwrite(path, picture);
  } catch (const cv::Exception&) {
    written = false;  // no codec for that ending
  }
  if (!written)
    throw Error(path + ": cannot write the picture (expected a writable name ending in .png or .pgm)");
}

}  // namespace heel::sim
