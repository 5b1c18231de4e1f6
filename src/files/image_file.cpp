#include "files/image_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "files/natural_order.h"
#include "heel/error.h"

namespace heel {
namespace {

namespace fs = std::filesystem;

/// Sends standard error to /dev/null for as long as it lives: libpng and libjpeg print messages of their own
/// there, and a command prints one line for an error.
class SilencedStderr {
 public:
  SilencedStderr() : original_fd_(dup(STDERR_FILENO)) {
    const int null_fd = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (original_fd_ >= 0 && null_fd >= 0) dup2(null_fd, STDERR_FILENO);
    if (null_fd >= 0) close(null_fd);
  }
  ~SilencedStderr() {
    if (original_fd_ < 0) return;
    dup2(original_fd_, STDERR_FILENO);
    close(original_fd_);
  }
  SilencedStderr(const SilencedStderr&) = delete;
  SilencedStderr& operator=(const SilencedStderr&) = delete;

 private:
  int original_fd_;
};

bool has_image_ending(const std::string& path) {
  static constexpr std::array kEndings{".png", ".jpg", ".jpeg", ".bmp",  ".pgm",
                                       ".ppm", ".pnm", ".tif",  ".tiff", ".webp"};
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace

bool is_image_file(const std::string& path) {
  if (has_image_ending(path)) return true;
  try {
    return cv::haveImageReader(path);
  } catch (const cv::Exception&) {
    return false;
  }
}

std::vector<std::string> images_in_folder(const std::string& folder, std::error_code& error) {
  std::vector<std::string> images;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string path = entry.path().string();
    if (entry.is_regular_file() && is_image_file(path)) images.push_back(path);
  }
  std::sort(images.begin(), images.end(), natural_less);
  return images;
}

cv::Mat decode_grey_image(const std::string& path) {
  try {
    return cv::imread(path, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

cv::Mat read_grey_image(const std::string& path) {
  if (fs::is_directory(path)) throw Error(path + ": a folder (expected an image)");
  if (!std::ifstream(path)) throw Error(path + ": cannot read: " + std::strerror(errno));
  const SilencedStderr silenced;
  cv::Mat grey = decode_grey_image(path);
  if (grey.empty())
    throw Error(path + ": not a whole image (expected PNG, JPEG, PGM, PPM, BMP, TIFF or WebP)");
  return grey;
}

FrameView frame_view_of(const cv::Mat& grey) {
  FrameView view;
  view.header.width_px = static_cast<std::uint32_t>(grey.cols);
  view.header.height_px = static_cast<std::uint32_t>(grey.rows);
  view.grey = grey.data;
  view.stride_bytes = static_cast<std::uint32_t>(grey.step[0]);
  return view;
}

void require_writable_image_name(const std::string& path) {
  bool known = false;
  try {
    known = cv::haveImageWriter(path);
  } catch (const cv::Exception&) {
    known = false;
  }
  if (!known) throw Error(path + ": unknown kind of picture (expected a name ending in .png or .jpg)");
}

void write_image(const std::string& path, const cv::Mat& image) {
  bool written = false;
  try {
    written = cv::imwrite(path, image);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written)
    throw Error(
        path +
        ": cannot write the picture (expected a folder that can be written, and a name ending in .png, "
        ".jpg or .pgm)");
}

void write_grey_image(const std::string& path, const std::uint8_t* grey, int width_px, int height_px,
                      std::size_t stride_bytes) {
  // OpenCV takes a mutable pointer, but only reads through it.
  write_image(path, cv::Mat(height_px, width_px, CV_8U, const_cast<std::uint8_t*>(grey),
                            stride_bytes == 0 ? std::size_t{cv::Mat::AUTO_STEP} : stride_bytes));
}

}  // namespace heel
