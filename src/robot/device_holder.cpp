#include "robot/device_holder.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace heel {
namespace {

namespace fs = std::filesystem;

int number_of(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
}

std::string program_of(int pid) {
  std::ifstream file(fmt::format("/proc/{}/comm", pid));
  std::string name;
  std::getline(file, name);
  return name;
}

/// The process that holds a lock on the file, by /proc/locks: "1: FLOCK ADVISORY WRITE PID MAJOR:MINOR:INODE
/// …", the numbers of the device in hexadecimal.
int pid_of_lock(const struct stat& file) {
  const std::string place =
      fmt::format("{:02x}:{:02x}:{}", major(file.st_dev), minor(file.st_dev), file.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, mode, access, pid, at;
    words >> number >> kind >> mode >> access >> pid >> at;
    if (at == place && number_of(pid) > 0 && number_of(pid) != ::getpid()) return number_of(pid);
  }
  return 0;
}

bool has_open(const fs::path& descriptors, const struct stat& device) {
  std::error_code error;
  for (fs::directory_iterator at(descriptors, error), end; !error && at != end; at.increment(error)) {
    struct stat one {};
    if (::stat(at->path().c_str(), &one) == 0 && S_ISCHR(one.st_mode) && one.st_rdev == device.st_rdev &&
        one.st_dev == device.st_dev && one.st_ino == device.st_ino)
      return true;
  }
  return false;
}

}  // namespace

std::optional<DeviceHolder> other_holder_of(const std::string& path) {
  struct stat device {};
  if (::stat(path.c_str(), &device) != 0) return std::nullopt;
  int pid = pid_of_lock(device);
  std::error_code error;
  for (fs::directory_iterator at("/proc", error), end; pid == 0 && !error && at != end; at.increment(error)) {
    const int other = number_of(at->path().filename().string());
    if (other > 0 && other != ::getpid() && has_open(at->path() / "fd", device)) pid = other;
  }
  if (pid == 0) return std::nullopt;
  return DeviceHolder{pid, program_of(pid)};
}

std::string in_use_text(const std::optional<DeviceHolder>& holder) {
  if (!holder) return "in use by another program; stop it first";
  const std::string program = holder->program.empty() ? "another program" : holder->program;
  const char* const how = program == "heeld" ? " (systemctl stop heeld)" : "";
  return fmt::format("in use by {} (process {}); stop it first{}", program, holder->pid, how);
}

}  // namespace heel
