#include "device_list.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <set>

namespace heel::cli {
namespace {

namespace fs = std::filesystem;

/// Paths in `folder` of which the name begins with one of `beginnings`, in the order of their names.
std::vector<std::string> devices_in(const fs::path& folder, std::initializer_list<const char*> beginnings) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    for (const char* beginning : beginnings)
      if (name.starts_with(beginning)) paths.push_back(entry.path().string());
  }
  std::ranges::sort(paths, [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;  // video2 before video10
  });
  return paths;
}

/// The link of udev in `folder` that leads to the device; the device itself where there is none.
std::string lasting_path(const std::string& device, const fs::path& folder) {
  std::error_code error;
  for (const std::string& link : devices_in(folder, {""}))
    if (fs::equivalent(link, device, error)) return link;
  return device;
}

/// Empty where the device gives no pictures.
std::string name_of_video_device(const std::string& path) {
  const int fd = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return "cannot be opened by this user";
  v4l2_capability capability{};
  const bool answered = ioctl(fd, VIDIOC_QUERYCAP, &capability) == 0;
  close(fd);
  if (!answered || (capability.device_caps & V4L2_CAP_VIDEO_CAPTURE) == 0) return "";
  return reinterpret_cast<const char*>(capability.card);
}

}  // namespace

std::vector<ListedDevice> video_devices() {
  std::vector<ListedDevice> devices;
  for (const std::string& path : devices_in("/dev", {"video"})) {
    const std::string name = name_of_video_device(path);
    if (!name.empty()) devices.push_back({lasting_path(path, "/dev/v4l/by-id"), name});
  }
  return devices;
}

std::vector<std::string> serial_devices() {
  std::vector<std::string> paths;
  std::set<fs::path> seen;
  for (const char* beginning : {"heel-robot", "ttyUSB", "ttyACM"}) {
    for (const std::string& path : devices_in("/dev", {beginning})) {
      std::error_code error;
      const fs::path device = fs::canonical(path, error);
      if (error || !seen.insert(device).second) continue;
      const bool is_link = device != fs::path(path);
      paths.push_back(is_link ? path : lasting_path(path, "/dev/serial/by-id"));
    }
  }
  return paths;
}

}  // namespace heel::cli
