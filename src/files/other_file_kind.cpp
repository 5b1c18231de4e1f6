#include "files/other_file_kind.h"

#include <array>
#include <cctype>
#include <fstream>
#include <string_view>

namespace heel {
namespace {

/// Whether the text, after spaces, begins with `lower` in any case.
bool begins_as_text(ByteView head, std::string_view lower) {
  std::size_t begin = 0;
  while (begin < head.size() && std::isspace(head[begin]) != 0) ++begin;
  if (head.size() - begin < lower.size()) return false;
  for (std::size_t i = 0; i < lower.size(); ++i)
    if (std::tolower(head[begin + i]) != lower[i]) return false;
  return true;
}

}  // namespace

std::string other_file_kind(ByteView head) {
  if (head.empty()) return "an empty file";
  if (begins_with(head, "version https://git-lfs"))
    return "a Git LFS pointer, not the file itself (git lfs pull fetches it)";
  if (begins_as_text(head, "<!doctype html") || begins_as_text(head, "<html"))
    return "a web page, not the file itself (download it again, and open it in a browser to see why)";
  if (begins_with(head, "#ROSBAG") || begins_with(head, "\x89MCAP") || begins_with(head, "SQLite format 3"))
    return "a recording of topics, as a ROS bag (export its pictures to a folder)";
  if (begins_with(head, "PK\x03\x04") || begins_with(head, "\x1f\x8b") || begins_with(head, "7z\xbc\xaf") ||
      begins_with(head, "Rar!") || begins_with(head, "\x28\xb5\x2f\xfd") ||
      begins_with(head,
                  "\xfd"
                  "7zXZ"))
    return "a compressed archive (unpack it)";
  return "";
}

std::string other_file_kind_of(const std::string& path) {
  std::array<std::uint8_t, 64> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file) return "";
  file.read(reinterpret_cast<char*>(head.data()), head.size());
  return other_file_kind(ByteView(head).first(static_cast<std::size_t>(file.gcount())));
}

}  // namespace heel
