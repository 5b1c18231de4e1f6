// Still images in and out (see image_file.h).
#include "files/image_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "heel/error.h"

namespace heel {
namespace {

/// Sends standard error to nowhere for as long as it lives: libpng and libjpeg print their own complaints
/// there, where the command's one line is to stand.
class QuietStderr {
 public:
  QuietStderr() : kept_(dup(STDERR_FILENO)) {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (kept_ >= 0 && nowhere >= 0) dup2(nowhere, STDERR_FILENO);
    if (nowhere >= 0) close(nowhere);
  }
  ~QuietStderr() {
    if (kept_ < 0) return;
    dup2(kept_, STDERR_FILENO);
    close(kept_);
  }
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  int kept_;
};

}  // namespace

cv::Mat read_grey_image(const std::string& path) {
  if (std::filesystem::is_directory(path)) throw Error(path + ": a folder (expected an image)");
  if (!std::ifstream(path)) throw Error(path + ": cannot read: " + std::strerror(errno));
  cv::Mat grey;
  try {
    const QuietStderr quiet;
    grey = cv::imread(path, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    grey.release();
  }
  if (grey.empty())
    throw Error(path + ": not a whole image (expected PNG, JPEG, PGM, PPM, BMP, TIFF or WebP)");
  return grey;
}

void require_writable_picture_name(const std::string& path) {
  bool known = false;
  try {
    known = cv::haveImageWriter(path);
  } catch (const cv::Exception&) {
    known = false;
  }
  if (!known) throw Error(path + ": unknown kind of picture (expected a name ending in .png or .jpg)");
}

void write_picture(const std::string& path, const cv::Mat& picture) {
  bool written = false;
  try {
    written = cv::imwrite(path, picture);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) throw Error(path + ": cannot write the picture");
}

}  // namespace heel
