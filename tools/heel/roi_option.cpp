#include "roi_option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <optional>

#include "heel/error.h"

namespace heel::cli {
namespace {

const std::string kForm = "X,Y,W,H: left, top, width and height in whole pixels, e.g. 250,120,140,180";

/// The numbers between commas and spaces; none where something else is there.
std::optional<std::vector<int>> numbers_in(const std::string& text) {
  std::vector<int> numbers;
  const char *at = text.data(), *const end = at + text.size();
  while (at != end) {
    if (*at == ',' || std::isspace(static_cast<unsigned char>(*at)) != 0) {
      ++at;
      continue;
    }
    int number = 0;
    const auto [used, error] = std::from_chars(at, end, number);
    const bool ends = used == end || *used == ',' || std::isspace(static_cast<unsigned char>(*used)) != 0;
    if (error != std::errc{} || !ends) return std::nullopt;
    numbers.push_back(number);
    at = used;
  }
  return numbers;
}

/// "240x140+10+5", as ImageMagick and X11 write a rectangle.
std::string hint_of_geometry(const std::string& text) {
  int width = 0, height = 0, x = 0, y = 0, used = 0;
  if (std::sscanf(text.c_str(), "%9dx%9d%9d%9d%n", &width, &height, &x, &y, &used) != 4 ||
      static_cast<std::size_t>(used) != text.size())
    return "";
  return fmt::format("; WxH+X+Y is {},{},{},{} here", x, y, width, height);
}

bool is_inside(const Region& region, const CameraModel& camera) {
  return region.x_px >= 0 && region.y_px >= 0 && region.width_px >= 1 && region.height_px >= 1 &&
         region.width_px <= camera.width_px - region.x_px &&
         region.height_px <= camera.height_px - region.y_px;
}

/// Of a rectangle that is not inside the picture, but is when its last two numbers are its other corner.
std::string hint_of_corners(const Region& given, const CameraModel& camera) {
  if (std::min({given.x_px, given.y_px, given.width_px, given.height_px}) < 0) return "";
  const Region by_corners{given.x_px, given.y_px, given.width_px - given.x_px, given.height_px - given.y_px};
  if (!is_inside(by_corners, camera)) return "";
  return fmt::format("; between two corners it is {},{},{},{}", by_corners.x_px, by_corners.y_px,
                     by_corners.width_px, by_corners.height_px);
}

}  // namespace

std::string read_roi(const std::string& text, const CameraModel& camera, Region& region) {
  const std::optional<std::vector<int>> numbers = numbers_in(text);
  if (!numbers || numbers->size() != 4) return kForm + hint_of_geometry(text);
  const Region given{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
  if (!is_inside(given, camera))
    return fmt::format("X,Y,W,H inside the {}x{} image{}", camera.width_px, camera.height_px,
                       hint_of_corners(given, camera));
  region = given;
  return "";
}

Region parse_roi(const std::vector<std::string>& words, const CameraModel& camera) {
  const std::string text = fmt::format("{}", fmt::join(words, " "));
  Region region;
  const std::string expected = read_roi(text, camera, region);
  if (!expected.empty()) throw Error(fmt::format("--roi: '{}' (expected {})", text, expected));
  return region;
}

}  // namespace heel::cli
