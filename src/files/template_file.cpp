// The .heel template file, format version 1:
//
//   "heel-template 1 <header bytes> <image bytes>\n"   text, so that `head -n 20 shirt.heel` shows what it is
//   header                                             JSON: region, distance, camera, settings
//   image                                              PNG, 8-bit grey, the whole reference view
//   checksum                                           CRC-32 (zlib) of everything before it, 4 bytes, little
//   endian
//
// The checksum is tested right after the version: an error found later is an error of the program that made
// the file, not damage in storage.
#include "files/template_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>

#include "files/atomic_file.h"
#include "heel/error.h"
#include "heel/shirt_template.h"

namespace heel {
namespace {

using Json = nlohmann::ordered_json;

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
  for (double value : {c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3}) {
    if (!std::isfinite(value)) return false;
  }
  return true;
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
}

Json header_json(const ShirtTemplate& shirt) {
  const CameraModel& c = shirt.camera;
  const Region& r = shirt.roi;
  return {
      {"region", {{"x_px", r.x_px}, {"y_px", r.y_px}, {"width_px", r.width_px}, {"height_px", r.height_px}}},
      {"distance_m", shirt.distance_m},
      {"yaw_rad", shirt.yaw_rad},
      {"camera",
       {{"width_px", c.width_px},
        {"height_px", c.height_px},
        {"fx", c.fx},
        {"fy", c.fy},
        {"cx", c.cx},
        {"cy", c.cy},
        {"k1", c.k1},
        {"k2", c.k2},
        {"p1", c.p1},
        {"p2", c.p2},
        {"k3", c.k3}}},
      {"settings", {{"oriented", shirt.oriented}, {"max_features", shirt.max_features}}}};
}

void parse_header(std::string_view text, const std::string& path, ShirtTemplate& shirt) {
  try {
    const Json header = Json::parse(text);
    const Json& region = header.at("region");
    region.at("x_px").get_to(shirt.roi.x_px);
    region.at("y_px").get_to(shirt.roi.y_px);
    region.at("width_px").get_to(shirt.roi.width_px);
    region.at("height_px").get_to(shirt.roi.height_px);
    header.at("distance_m").get_to(shirt.distance_m);
    shirt.yaw_rad = header.value("yaw_rad", 0.0);  // older files have none
    const Json& camera = header.at("camera");
    camera.at("width_px").get_to(shirt.camera.width_px);
    camera.at("height_px").get_to(shirt.camera.height_px);
    camera.at("fx").get_to(shirt.camera.fx);
    camera.at("fy").get_to(shirt.camera.fy);
    camera.at("cx").get_to(shirt.camera.cx);
    camera.at("cy").get_to(shirt.camera.cy);
    camera.at("k1").get_to(shirt.camera.k1);
    camera.at("k2").get_to(shirt.camera.k2);
    camera.at("p1").get_to(shirt.camera.p1);
    camera.at("p2").get_to(shirt.camera.p2);
    camera.at("k3").get_to(shirt.camera.k3);
    header.at("settings").at("oriented").get_to(shirt.oriented);
    header.at("settings").at("max_features").get_to(shirt.max_features);
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("{}: header: {} (expected the header of format version {})", path, error.what(),
                            kTemplateFormatVersion));
  }
}

std::string png_of(const ShirtTemplate& shirt) {
  const cv::Mat grey(shirt.camera.height_px, shirt.camera.width_px, CV_8UC1,
                     const_cast<std::uint8_t*>(shirt.grey.data()));
  std::vector<std::uint8_t> png;
  cv::imencode(".png", grey, png);
  return {png.begin(), png.end()};
}

void decode_png(std::string_view png, const std::string& path, ShirtTemplate& shirt) {
  cv::Mat grey;
  try {
    const cv::Mat bytes(1, static_cast<int>(png.size()), CV_8UC1, const_cast<char*>(png.data()));
    if (!png.empty()) grey = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    grey.release();
  }
  require(grey.cols == shirt.camera.width_px && grey.rows == shirt.camera.height_px, path, "image",
          fmt::format("a PNG of the camera's {}x{} pixels", shirt.camera.width_px, shirt.camera.height_px));
  shirt.grey.assign(grey.datastart, grey.dataend);
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
  if (version != static_cast<std::size_t>(kTemplateFormatVersion))
    throw Error(fmt::format("{}: format version {} (expected {}; a newer heel may have made it)", path,
                            version, kTemplateFormatVersion));
  if (!take_number(line, ' ', first.header_bytes) || !take_number(line, '\n', first.image_bytes) ||
      !line.empty() || first.header_bytes > kMaxTemplateBytes || first.image_bytes > kMaxTemplateBytes)
    throw damaged_first_line(path);
  return first;
}

struct Parts {
  std::string_view header;
  std::string_view image;
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
  parse_header(parts.header, path, shirt);
  decode_png(parts.image, path, shirt);
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
  const std::string header = header_json(shirt).dump(2) + "\n";
  const std::string image = png_of(shirt);
  std::string file = fmt::format("{}{} {} {}\n{}{}", kTemplateMagic, kTemplateFormatVersion, header.size(),
                                 image.size(), header, image);
  const auto checksum = little_endian(crc32_of(file));
  file.append(checksum.data(), checksum.size());
  write_file_atomically(path, file);
}

}  // namespace heel
