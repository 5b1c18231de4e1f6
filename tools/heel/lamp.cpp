#include "lamp.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "heel/error.h"

namespace heel::cli {
namespace {

void write_whole(int fd, std::string_view text, const std::string& name) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw Error(name + ": cannot write: " + std::strerror(errno));
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

class OpenFile {
 public:
  OpenFile(const std::string& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC)) {
    if (fd_ < 0) throw Error(path + ": cannot open: " + std::strerror(errno));
  }
  ~OpenFile() { ::close(fd_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

// Escape sequences of ECMA-48 and xterm.
constexpr std::string_view kOtherScreen = "\x1b[?1049h\x1b[?25l", kOwnScreen = "\x1b[0m\x1b[?25h\x1b[?1049l";
constexpr std::string_view kWhite = "\x1b[48;2;255;255;255m\x1b[2J", kBlack = "\x1b[48;2;0;0;0m\x1b[2J";

class TerminalLamp final : public Lamp {
 public:
  TerminalLamp() : terminal_("/dev/tty", O_WRONLY) { write(kOtherScreen); }
  ~TerminalLamp() override {
    try {
      write(kOwnScreen);
    } catch (const Error&) {  // the terminal has gone
    }
  }
  void set(bool on) override { write(on ? kWhite : kBlack); }

 private:
  void write(std::string_view text) { write_whole(terminal_.fd(), text, "the terminal"); }

  OpenFile terminal_;
};

/// The number that is all the file holds. Throws heel::Error where it holds something else.
std::string number_in(const std::string& path) {
  std::ifstream in(path);
  std::string number, more;
  in >> number;
  if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos || in >> more)
    throw Error(path +
                ": holds no number (expected a light's file, such as /sys/class/leds/NAME/brightness)");
  return number;
}

std::string brightest_of(const std::string& path) {
  const std::string file = std::filesystem::path(path).replace_filename("max_brightness").string();
  return std::filesystem::exists(file) ? number_in(file) : "1";
}

class FileLamp final : public Lamp {
 public:
  explicit FileLamp(const std::string& path)
      : path_(path), file_(path, O_WRONLY), before_(number_in(path)), lit_(brightest_of(path)) {}
  ~FileLamp() override {
    try {
      write(before_);
    } catch (const Error&) {  // the light has gone
    }
  }
  void set(bool on) override { write(on ? lit_ : "0"); }

 private:
  void write(const std::string& number) {
    if (::lseek(file_.fd(), 0, SEEK_SET) < 0)
      throw Error(path_ + ": " + std::strerror(errno) + " (expected a file such as an LED's brightness)");
    write_whole(file_.fd(), number + "\n", path_);
  }

  std::string path_;
  OpenFile file_;
  std::string before_, lit_;
};

}  // namespace

std::unique_ptr<Lamp> terminal_lamp() {
  try {
    return std::make_unique<TerminalLamp>();
  } catch (const Error&) {
    throw Error(
        "--lamp: missing, and there is no terminal to switch (expected a file, such as "
        "/sys/class/leds/NAME/brightness)");
  }
}

std::unique_ptr<Lamp> file_lamp(const std::string& path) {
  return std::make_unique<FileLamp>(path);
}

}  // namespace heel::cli
