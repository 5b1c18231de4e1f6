#include "robot/serial_hints.h"

#include <fmt/format.h>
#include <grp.h>
#include <libserialport.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "robot/device_holder.h"

namespace heel {
namespace {

constexpr std::size_t kMostNamed = 3;

/// "dialout", or the group's number where it has no name.
std::string group_name(gid_t id) {
  group entry{};
  group* found = nullptr;
  std::array<char, 4096> buffer{};
  const bool named = ::getgrgid_r(id, &entry, buffer.data(), buffer.size(), &found) == 0 && found != nullptr;
  return named ? entry.gr_name : std::to_string(id);
}

std::optional<UsbAdapter> adapter_of(sp_port* port) {
  UsbAdapter adapter;
  adapter.device = sp_get_port_name(port);
  if (sp_get_port_usb_vid_pid(port, &adapter.vendor, &adapter.product) != SP_OK) return std::nullopt;
  if (const char* const serial = sp_get_port_usb_serial(port); serial != nullptr) adapter.serial = serial;
  return adapter;
}

}  // namespace

bool is_pty(const std::string& path) {
  struct stat device {};
  constexpr unsigned kFirstMajor = 136, kLastMajor = 143;  // of Unix98 pseudo-terminals
  return ::stat(path.c_str(), &device) == 0 && S_ISCHR(device.st_mode) &&
         major(device.st_rdev) >= kFirstMajor && major(device.st_rdev) <= kLastMajor;
}

std::string open_failure_text(const std::string& path, int error) {
  if (error == EBUSY) return in_use_text(other_holder_of(path));
  const std::string text = fmt::format("cannot open: {}", std::strerror(error));
  struct stat device {};
  if (error != EACCES || ::stat(path.c_str(), &device) != 0) return text;
  const std::string group = group_name(device.st_gid);
  const bool group_may = (device.st_mode & (S_IRGRP | S_IWGRP)) == (S_IRGRP | S_IWGRP);
  return group_may ? fmt::format("{} (only the group {} may: sudo usermod -aG {} $USER, then log in again)",
                                 text, group, group)
                   : fmt::format("{} (only its owner may; check the udev rule that made it)", text);
}

std::string missing_device_text(const std::string& by_id) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator at(by_id, error), end; !error && at != end; at.increment(error))
    names.push_back(at->path().string());
  std::sort(names.begin(), names.end());
  const std::size_t left_out = names.size() > kMostNamed ? names.size() - kMostNamed : 0;
  names.resize(names.size() - left_out);
  const std::string text = fmt::format("cannot open: {}", std::strerror(ENOENT));
  if (names.empty()) return text + " (no USB serial adapter is plugged in)";
  return fmt::format("{} (adapters that are here: {}{})", text, fmt::join(names, ", "),
                     left_out > 0 ? fmt::format(" and {} more", left_out) : "");
}

std::optional<UsbAdapter> usb_adapter_of(const std::string& device) {
  sp_port* port = nullptr;
  if (sp_get_port_by_name(device.c_str(), &port) != SP_OK) return std::nullopt;
  const auto adapter = adapter_of(port);
  sp_free_port(port);
  return adapter;
}

std::vector<UsbAdapter> usb_adapters() {
  std::vector<UsbAdapter> adapters;
  sp_port** ports = nullptr;
  if (sp_list_ports(&ports) != SP_OK) return adapters;
  for (sp_port** at = ports; *at != nullptr; ++at) {
    if (const auto adapter = adapter_of(*at)) adapters.push_back(*adapter);
  }
  sp_free_port_list(ports);
  return adapters;
}

std::optional<UsbAdapter> moved_to(const UsbAdapter& gone, const std::vector<UsbAdapter>& present) {
  const auto is_same = [&](const UsbAdapter& one) { return one.is_same_as(gone); };
  if (std::count_if(present.begin(), present.end(), is_same) != 1) return std::nullopt;
  return *std::find_if(present.begin(), present.end(), is_same);
}

}  // namespace heel
