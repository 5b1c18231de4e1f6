#include "capture/v4l2/device_users.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace heel {
namespace {

namespace fs = std::filesystem;

bool holds(const fs::path& process, const fs::path& device) {
  std::error_code error;
  for (fs::directory_iterator fd(process / "fd", error), end; !error && fd != end; fd.increment(error)) {
    std::error_code unreadable;
    if (fs::read_symlink(fd->path(), unreadable) == device) return true;
  }
  return false;
}

}  // namespace

std::string programs_holding(const std::string& device_path) {
  std::error_code error;
  const fs::path device = fs::canonical(device_path, error);
  if (error) return "";
  std::string programs;
  for (fs::directory_iterator entry("/proc", error), end; !error && entry != end; entry.increment(error)) {
    const std::string pid = entry->path().filename().string();
    const bool is_process =
        std::all_of(pid.begin(), pid.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!is_process || pid == std::to_string(getpid()) || !holds(entry->path(), device)) continue;
    std::string name;
    std::getline(std::ifstream(entry->path() / "comm"), name);
    programs += fmt::format("{}{} (process {})", programs.empty() ? "" : ", ", name, pid);
  }
  return programs;
}

}  // namespace heel
