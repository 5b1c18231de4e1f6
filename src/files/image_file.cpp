#include "files/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <string_view>

#include "files/atomic_file.h"
#include "files/byte_view.h"
#include "files/exif.h"
#include "files/jpeg_decoder.h"
#include "files/natural_order.h"
#include "files/orientation.h"
#include "files/other_file_kind.h"
#include "files/picture_depth.h"
#include "files/picture_kind.h"
#include "files/png_picture.h"
#include "files/pnm_picture.h"
#include "heel/error.h"

namespace heel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReadableKinds = "PNG, JPEG, PGM, PPM, BMP, TIFF or WebP";
constexpr const char* kEndMissing =
    "its end is missing, as of a download that was interrupted; every row is there";
constexpr std::size_t kMaxPixels = std::size_t{1} << 27;
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 29;

bool is_jpeg(ByteView file) {
  return begins_with(file, "\xff\xd8");
}

bool is_png(ByteView file) {
  return begins_with(file, "\x89PNG");
}

bool is_pnm(ByteView file, char first, char last) {
  return file.size() > 2 && file[0] == 'P' && file[1] >= first && file[1] <= last &&
         std::isspace(file[2]) != 0;
}

/// As a picture has it that is spelled in base64, or a message in place of a picture.
bool is_text(ByteView file) {
  const ByteView head = file.first(std::min(file.size(), kPictureKindBytes));
  return std::all_of(head.begin(), head.end(),
                     [](int c) { return std::isprint(c) != 0 || std::isspace(c) != 0; });
}

/// BMP, PGM, PPM, TIFF and WebP. OpenCV is given no other kind: its reader of DICOM files ends the program at
/// some.
bool is_for_opencv(ByteView file) {
  const bool is_webp = begins_with(file, "RIFF") && file.size() >= 12 && begins_with(file.subspan(8), "WEBP");
  return begins_with(file, "BM") || begins_with(file, std::string_view("II*\0", 4)) ||
         begins_with(file, std::string_view("MM\0*", 4)) || is_pnm(file, '1', '6') || is_webp;
}

cv::Mat decode_jpeg(ByteView file, std::string& missing, std::string& problem) {
  JpegDecoder decoder;
  std::uint32_t width_px = 0, height_px = 0;
  cv::Mat grey;
  if (decoder.read_size(file.data(), file.size(), width_px, height_px)) {
    if (std::size_t{width_px} * height_px > kMaxPixels) {
      problem = "too large";
      return {};
    }
    grey.create(static_cast<int>(height_px), static_cast<int>(width_px), CV_8U);
    if (decoder.decode(file.data(), file.size(), width_px, height_px, grey.data)) {
      if (!decoder.has_end()) missing = kEndMissing;
      return grey;
    }
  }
  problem = decoder.problem();
  return {};
}

cv::Mat picture_in_png(ByteView file, int& significant_bits, std::string& missing, std::string& problem) {
  PngPicture picture = decode_png(file);
  significant_bits = picture.significant_bits;
  problem = picture.problem;
  if (picture.bytes.empty()) return {};
  if (!picture.has_end) missing = kEndMissing;
  return cv::Mat(static_cast<int>(picture.height_px), static_cast<int>(picture.width_px),
                 picture.deep ? CV_16U : CV_8U, picture.bytes.data())
      .clone();
}

/// Makes std::cerr silent for as long as it lives: there OpenCV prints what it cannot decode, and heel prints
/// one line for an error. heel itself prints to stderr, not to std::cerr, while it decodes. One thread at a
/// time.
class SilentCerr {
 public:
  SilentCerr() : lock_(mutex()), buffer_(std::cerr.rdbuf(nullptr)) {}
  ~SilentCerr() {
    std::cerr.rdbuf(buffer_);
    std::cerr.clear();
  }
  SilentCerr(const SilentCerr&) = delete;
  SilentCerr& operator=(const SilentCerr&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }

  std::lock_guard<std::mutex> lock_;
  std::streambuf* buffer_;
};

cv::Mat decode_by_opencv(std::string& file, ByteView view) {
  // OpenCV turns TIFF pictures, and no others of these, whether it is told to or not.
  const TiffTags tags = read_tiff_tags(view);
  const std::size_t at = tags.orientation_at, end = at + tags.orientation_bytes;
  if (at > 0 && end <= file.size()) {
    std::fill_n(file.begin() + static_cast<std::ptrdiff_t>(at), tags.orientation_bytes, '\0');
    file[file.starts_with("II") ? at : end - 1] = kAsStored;
  }
  const cv::Mat bytes(1, static_cast<int>(file.size()), CV_8U, file.data());
  const SilentCerr silent;
  try {
    return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

/// The value of white that the file states; 0 when it states none.
int stated_white(ByteView file, int significant_bits) {
  if (significant_bits > 0) return (1 << significant_bits) - 1;
  if (const int largest = largest_value_of_pnm(file); largest > 0) return largest;
  return read_tiff_tags(file).max_sample_value;
}

/// Why the decoded pixels, or none, are no picture.
std::string problem_of(const cv::Mat& raw, const TiffTags& tags, const std::string& problem) {
  const std::string expected =
      std::string(" (expected ") + kReadableKinds + " of 8 to 16 bits a pixel; export it as such)";
  if (tags.has_floats || raw.depth() > CV_32S) return "its pixels are floating-point numbers" + expected;
  if (raw.depth() == CV_16S || raw.depth() == CV_8S) return "its pixels are signed numbers" + expected;
  if (tags.bits > 16 || !raw.empty()) return "its pixels have more than 16 bits" + expected;
  return "not a whole image" + (problem.empty() ? "" : ": " + problem) + " (expected " + kReadableKinds +
         " of 8 to 16 bits a pixel)";
}

ByteView view_of(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

GreyImage decode_bytes(std::string& bytes, int least_white) {
  if (is_pnm(view_of(bytes), '1', '3')) bytes += '\n';  // OpenCV needs a character after the last number
  const ByteView file = view_of(bytes);
  GreyImage image;
  if (const std::string kind = unreadable_picture_kind(file); !kind.empty()) {
    image.problem = kind + " file, which heel does not read (expected " + kReadableKinds +
                    "; save or export it as JPEG or PNG)";
    return image;
  }
  if (const std::string video = video_kind(file); !video.empty()) {
    image.problem = video + " video with a picture's name: rename it (expected " + kReadableKinds + ")";
    return image;
  }
  if (const std::string other = other_file_kind(file); !other.empty()) {
    image.problem = other + ": expected " + kReadableKinds;
    return image;
  }
  const int orientation = orientation_in_file(file);
  int significant_bits = 0;
  cv::Mat raw;
  if (is_jpeg(file)) {
    raw = decode_jpeg(file, image.missing, image.problem);
  } else if (is_png(file)) {
    raw = picture_in_png(file, significant_bits, image.missing, image.problem);
  } else if (is_for_opencv(file)) {
    raw = decode_by_opencv(bytes, file);
  } else if (is_text(file)) {
    image.problem = "it is text";
  }
  if (raw.empty() || (raw.depth() != CV_8U && raw.depth() != CV_16U)) {
    image.problem = problem_of(raw, read_tiff_tags(file), image.problem);
    return image;
  }
  image.problem.clear();
  EightBitPicture picture = to_8_bit(raw, stated_white(file, significant_bits), least_white);
  image.grey = shown_picture(picture.grey, orientation);
  image.note = std::move(picture.note);
  image.white = picture.white;
  return image;
}

constexpr std::array kImageEndings{".png", ".jpg", ".jpeg", ".bmp",  ".pgm",
                                   ".ppm", ".pnm", ".tif",  ".tiff", ".webp"};
// One JPEG picture after another: without a look at the name, only the first would be used.
constexpr std::array kMotionJpegEndings{".mjpeg", ".mjpg"};
// Of kinds of videos that have no beginning of their own.
constexpr std::array kVideoEndings{".mts", ".m2ts", ".h264", ".h265", ".264", ".265"};

template <typename Endings>
bool has_one_of(const Endings& endings, const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

// Beside each picture on a stick, macOS leaves "._NAME", which is none.
bool is_hidden(const fs::path& path) {
  return path.filename().string().starts_with('.');
}

using Head = std::array<std::uint8_t, kPictureKindBytes>;

/// The beginning of a file; zeros where there is none.
Head head_of(const std::string& path) {
  Head head{};
  if (std::error_code none; fs::is_regular_file(path, none))
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(head.data()), head.size());
  return head;
}

bool is_video_file(const std::string& path) {
  return has_one_of(kMotionJpegEndings, path) || has_one_of(kVideoEndings, path) ||
         !video_kind(head_of(path)).empty();
}

}  // namespace

bool is_image_file(const std::string& path) {
  if (has_one_of(kImageEndings, path)) return true;
  if (has_one_of(kMotionJpegEndings, path)) return false;
  const Head head = head_of(path);
  return is_jpeg(head) || is_png(head) || is_for_opencv(head) || !unreadable_picture_kind(head).empty();
}

FolderImages images_in_folder(const std::string& folder, std::error_code& error) {
  FolderImages found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string path = entry.path().string();
    if (!entry.is_regular_file() || is_hidden(entry.path())) continue;
    if (is_image_file(path))
      found.images.push_back(path);
    else if (is_video_file(path))
      found.videos.push_back(entry.path().filename().string());
  }
  std::sort(found.images.begin(), found.images.end(), natural_less);
  std::sort(found.videos.begin(), found.videos.end(), natural_less);
  return found;
}

std::string FolderImages::passed_over() const {
  if (videos.empty()) return "";
  if (videos.size() == 1)
    return videos.front() + " in it is a video, which is passed over: give it by its name";
  return fmt::format("{} and {} more videos in it are passed over: give each by its name", videos.front(),
                     videos.size() - 1);
}

GreyImage decode_grey_image(const std::string& path, int least_white) {
  try {
    std::string file = read_whole_file(path, kMaxFileBytes);
    return decode_bytes(file, least_white);
  } catch (const std::exception& error) {  // Error, or no memory
    return {{}, error.what(), "", "", 0};
  }
}

GreyImage read_grey_image(const std::string& path, int least_white) {
  if (fs::is_directory(path)) throw Error(path + ": a folder (expected an image)");
  require_regular_file(path);
  if (!std::ifstream(path)) throw Error(path + ": cannot read: " + std::strerror(errno));
  GreyImage image = decode_grey_image(path, least_white);
  if (image.grey.empty()) throw Error(path + ": " + image.problem);
  return image;
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
