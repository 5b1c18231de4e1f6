// The .heel template file, format versions 1 and 2:
//
//   "heel-template 1 <header bytes> <image bytes>\n"   text, so that `head -n 20 shirt.heel` shows what it is
//   header                                             JSON: region, distance, camera, settings
//   image                                              PNG, 8-bit grey, the whole reference view
//   checksum                                           CRC-32 (zlib) of everything before it, 4 bytes, little
//   endian
//
// Version 2 adds further views: the header's array "further_views" has the pose of each and the bytes of its
// PNG; these PNGs follow the reference view's and are part of <image bytes>. A template without further views
// is written as version 1, which earlier programs read.
//
// The checksum is tested right after the version: an error found later is an error of the program that made
// the file, not damage in storage.
#include "files/template_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <Eigen/LU>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "core/frame_view.h"
#include "files/atomic_file.h"
#include "files/grey_encoder.h"
#include "files/png_picture.h"
#include "files/template_header.h"
#include "heel/error.h"
#include "heel/shirt_template.h"

namespace heel {
namespace {

constexpr std::string_view kTemplateMagic = "heel-template ";
constexpr std::size_t kMaxTemplateBytes = std::size_t{1} << 28;
constexpr std::size_t kMaxFirstLineBytes = 64;
constexpr std::size_t kChecksumBytes = 4;
constexpr int kMaxImageSide_px = 32768;
constexpr int kMaxTemplateFeatures = 10000;
constexpr double kHalfTurn_rad = 3.1416;  // as 180° is read from a file

std::uint32_t crc32_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::array<char, kChecksumBytes> little_endian(std::uint32_t value) {
  return {static_cast<char>(value), static_cast<char>(value >> 8), static_cast<char>(value >> 16),
          static_cast<char>(value >> 24)};
}

/// Throws an error about `key` unless `holds`.
void require(bool holds, const std::string& path, const std::string& key, const std::string& what) {
  if (!holds) throw Error(path + ": " + key + ": expected " + what);
}

bool all_finite(const CameraModel& c) {
  for (double value : {c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6}) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

void validate_further(const ShirtTemplate& shirt, const std::string& path) {
  require(shirt.further_views.size() <= kMaxFurtherViews, path, "further_views",
          fmt::format("at most {}", kMaxFurtherViews));
  constexpr double kRotationTolerance = 1e-6;
  for (const FurtherView& further : shirt.further_views) {
    const Eigen::Matrix3d& R = further.R_further_from_ref;
    require(R.allFinite() && (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < kRotationTolerance &&
                R.determinant() > 0.0,
            path, "further_views: R_further_from_ref", "a rotation");
    require(further.t_over_d.allFinite(), path, "further_views: t_over_d", "finite numbers");
    require(further.grey.size() == shirt.grey.size(), path, "further_views", "pictures of the camera's size");
  }
}

/// What a template must satisfy, after reading and before writing.
void validate(const ShirtTemplate& shirt, const std::string& path) {
  const CameraModel& camera = shirt.camera;
  const auto side_ok = [](int side_px) { return side_px >= 1 && side_px <= kMaxImageSide_px; };
  require(side_ok(camera.width_px) && side_ok(camera.height_px), path, "camera.width_px, height_px",
          fmt::format("1…{}", kMaxImageSide_px));
  require(all_finite(camera), path, "camera", "finite numbers");
  require(camera.fx > 0 && camera.fy > 0, path, "camera.fx, fy", "above 0 px");
  const Region& roi = shirt.roi;
  require(roi.x_px >= 0 && roi.y_px >= 0 && roi.width_px >= 1 && roi.height_px >= 1 &&
              roi.width_px <= camera.width_px - roi.x_px && roi.height_px <= camera.height_px - roi.y_px,
          path, "region",
          fmt::format("a rectangle inside the {}x{} image", camera.width_px, camera.height_px));
  require(std::isfinite(shirt.distance_m) && shirt.distance_m >= 0, path, "distance_m",
          "metres above 0, or 0 when not known");
  require(std::isfinite(shirt.yaw_rad) && std::abs(shirt.yaw_rad) <= kHalfTurn_rad, path, "yaw_rad", "-π…π");
  require(shirt.max_features >= 1 && shirt.max_features <= kMaxTemplateFeatures, path, "max_features",
          fmt::format("1…{}", kMaxTemplateFeatures));
  require(shirt.grey.size() ==
              static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px),
          path, "image", "one byte a pixel of the camera");
  validate_further(shirt, path);
}

std::string png_of(const std::vector<std::uint8_t>& image, const CameraModel& camera) {
  return png_of_grey(packed_frame(image.data(), camera.width_px, camera.height_px));
}

std::vector<std::uint8_t> pixels_of(std::string_view png, const std::string& path,
                                    const CameraModel& camera) {
  PngPicture picture = decode_png({reinterpret_cast<const std::uint8_t*>(png.data()), png.size()});
  require(!picture.bytes.empty() && !picture.deep &&
              picture.width_px == static_cast<std::uint32_t>(camera.width_px) &&
              picture.height_px == static_cast<std::uint32_t>(camera.height_px),
          path, "image",
          fmt::format("a PNG of the camera's {}x{} pixels", camera.width_px, camera.height_px));
  return std::move(picture.bytes);
}

/// The reference view's picture, then those of the further views.
void decode_images(std::string_view images, const std::vector<std::size_t>& further_bytes,
                   const std::string& path, ShirtTemplate& shirt) {
  std::size_t left = images.size();
  for (const std::size_t bytes : further_bytes) {
    require(bytes <= left, path, "further_views: image_bytes", "no more than the file has");
    left -= bytes;
  }
  shirt.grey = pixels_of(images.substr(0, left), path, shirt.camera);
  for (std::size_t i = 0; i < further_bytes.size(); ++i) {
    shirt.further_views[i].grey = pixels_of(images.substr(left, further_bytes[i]), path, shirt.camera);
    left += further_bytes[i];
  }
}

/// Takes a number and the character after it from the front of `line`; false when they are not there.
bool take_number(std::string_view& line, char terminator, std::size_t& value) {
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  const auto used = static_cast<std::size_t>(end - line.data());
  if (error != std::errc{} || used >= line.size() || *end != terminator) return false;
  line.remove_prefix(used + 1);
  return true;
}

constexpr const char* kRemedy = "copy it again, or make it again with heel teach";

Error truncated(std::string_view file, const std::string& path) {
  return Error(fmt::format("{}: truncated at {} bytes ({})", path, file.size(), kRemedy));
}

Error damaged_first_line(const std::string& path) {
  return Error(path + ": damaged first line (expected \"heel-template VERSION BYTES BYTES\")");
}

/// What the first line states.
struct FirstLine {
  std::size_t bytes = 0;  ///< of the line itself
  std::size_t header_bytes = 0;
  std::size_t image_bytes = 0;
};

FirstLine parse_first_line(std::string_view file, const std::string& path) {
  if (file.empty() ||
      !file.starts_with(kTemplateMagic.substr(0, std::min(file.size(), kTemplateMagic.size()))))
    throw Error(path + ": not a template (expected a file made by heel teach)");
  const std::size_t line_end = file.substr(0, kMaxFirstLineBytes).find('\n');
  if (line_end == std::string_view::npos)
    throw file.size() < kMaxFirstLineBytes ? truncated(file, path) : damaged_first_line(path);
  FirstLine first;
  first.bytes = line_end + 1;
  std::string_view line = file.substr(kTemplateMagic.size(), first.bytes - kTemplateMagic.size());
  std::size_t version = 0;
  if (!take_number(line, ' ', version)) throw damaged_first_line(path);
  if (version < 1 || version > static_cast<std::size_t>(kTemplateFormatVersion))
    throw Error(fmt::format("{}: format version {} (expected 1…{}; a newer heel may have made it)", path,
                            version, kTemplateFormatVersion));
  if (!take_number(line, ' ', first.header_bytes) || !take_number(line, '\n', first.image_bytes) ||
      !line.empty() || first.header_bytes > kMaxTemplateBytes || first.image_bytes > kMaxTemplateBytes)
    throw damaged_first_line(path);
  return first;
}

struct Parts {
  std::string_view header;
  std::string_view images;
};

/// The parts of a file whose size and checksum are right.
Parts split(std::string_view file, const std::string& path) {
  const FirstLine first = parse_first_line(file, path);
  const std::size_t expected_bytes = first.bytes + first.header_bytes + first.image_bytes + kChecksumBytes;
  if (file.size() < expected_bytes) throw truncated(file, path);
  if (file.size() > expected_bytes)
    throw Error(fmt::format("{}: {} bytes (expected {})", path, file.size(), expected_bytes));
  const std::string_view body = file.substr(0, file.size() - kChecksumBytes);
  const auto checksum = little_endian(crc32_of(body));
  if (file.substr(body.size()) != std::string_view(checksum.data(), checksum.size()))
    throw Error(fmt::format("{}: checksum does not fit: damaged ({})", path, kRemedy));
  return {body.substr(first.bytes, first.header_bytes), body.substr(first.bytes + first.header_bytes)};
}

}  // namespace

ShirtTemplate read_template(const std::string& path) {
  const std::string file = read_whole_file(path, kMaxTemplateBytes);
  const Parts parts = split(file, path);
  ShirtTemplate shirt;
  const std::vector<std::size_t> further_bytes = parse_template_header(parts.header, path, shirt);
  decode_images(parts.images, further_bytes, path, shirt);
  validate(shirt, path);
  return shirt;
}

std::vector<ShirtTemplate> read_templates(const TargetConfig& config) {
  std::vector<ShirtTemplate> shirts{read_template(config.shirt)};
  if (config.distance_m > 0.0) shirts.front().distance_m = config.distance_m;
  for (const std::string& path : config.more_shirts) shirts.push_back(read_template(path));
  return shirts;
}

const std::string& template_file(const TargetConfig& config, std::size_t index) {
  return index == 0 ? config.shirt : config.more_shirts[index - 1];
}

void write_template(const ShirtTemplate& shirt, const std::string& path) {
  validate(shirt, path);
  std::string images = png_of(shirt.grey, shirt.camera);
  std::vector<std::size_t> further_bytes;
  for (const FurtherView& further : shirt.further_views) {
    const std::string png = png_of(further.grey, shirt.camera);
    further_bytes.push_back(png.size());
    images += png;
  }
  const std::string header = template_header(shirt, further_bytes);
  const int version = further_bytes.empty() ? 1 : kTemplateFormatVersion;
  std::string file =
      fmt::format("{}{} {} {}\n{}{}", kTemplateMagic, version, header.size(), images.size(), header, images);
  const auto checksum = little_endian(crc32_of(file));
  file.append(checksum.data(), checksum.size());
  write_file_atomically(path, file);
}

}  // namespace heel
