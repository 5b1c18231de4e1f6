#include "bundle_facts.h"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace heel::cli {
namespace {

namespace fs = std::filesystem;

/// The first line of a file; empty: none.
std::string line_of(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// What a program prints; empty where it is not installed.
std::string output_of(const char* command) {
  std::string text;
  std::FILE* const pipe = popen(command, "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), n);
  pclose(pipe);
  return text;
}

std::string value_in(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key)) return line;
  return key + ": not in " + file;
}

std::string versions() {
  utsname kernel{};
  uname(&kernel);
  std::string text = fmt::format("heel {}\n{} {} {} {}\n", HEEL_VERSION, kernel.sysname, kernel.release,
                                 kernel.version, kernel.machine);
  text += value_in("/etc/os-release", "PRETTY_NAME") + '\n';
  text += value_in("/proc/cpuinfo", "model name") + '\n' + value_in("/proc/meminfo", "MemTotal") + '\n';
  text += "PREEMPT_RT: " + line_of("/sys/kernel/realtime") + '\n';
  text += "sched_rt_runtime_us: " + line_of("/proc/sys/kernel/sched_rt_runtime_us") + '\n';
  text +=
      output_of("dpkg-query -W 'heel*' 'libcamera*' 'libopencv-core*' libserialport0 libzstd1 2>/dev/null");
  return text;
}

/// Without serial numbers.
std::string devices() {
  std::string text;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/sys/class/video4linux", none))
    text += fmt::format("/dev/{}: {}\n", entry.path().filename().string(), line_of(entry.path() / "name"));
  for (const auto& entry : fs::directory_iterator("/sys/class/tty", none))
    if (fs::exists(entry.path() / "device/driver", none))
      text += fmt::format("/dev/{}: {}\n", entry.path().filename().string(),
                          fs::read_symlink(entry.path() / "device/driver", none).filename().string());
  for (const auto& entry : fs::directory_iterator("/sys/bus/usb/devices", none))
    if (fs::exists(entry.path() / "idVendor", none))
      text += fmt::format("usb {}:{} {}\n", line_of(entry.path() / "idVendor"),
                          line_of(entry.path() / "idProduct"), line_of(entry.path() / "product"));
  return text;
}

}  // namespace

std::map<std::string, std::string> machine_facts() {
  std::map<std::string, std::string> facts{{"versions.txt", versions()}, {"devices.txt", devices()}};
  const std::string journal =
      output_of("journalctl -u heeld -o short-monotonic --no-hostname --no-pager -n 5000 2>/dev/null");
  if (!journal.empty()) facts["journal.txt"] = journal;
  return facts;
}

Redaction private_names() {
  Redaction redaction;
  utsname kernel{};
  if (uname(&kernel) == 0 && std::string(kernel.nodename) != "localhost")
    redaction.add_word(kernel.nodename, "HOST");
  constexpr uid_t kFirstPerson = 1000, kNobody = 65534;
  setpwent();
  for (const passwd* user = getpwent(); user != nullptr; user = getpwent())
    if (user->pw_uid >= kFirstPerson && user->pw_uid != kNobody) redaction.add_word(user->pw_name, "USER");
  endpwent();
  return redaction;
}

}  // namespace heel::cli
