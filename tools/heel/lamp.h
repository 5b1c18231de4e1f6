// A light that a program can switch: the terminal's own screen, or a file such as an LED's brightness.
#pragma once

#include <memory>
#include <string>

namespace heel::cli {

class Lamp {
 public:
  virtual ~Lamp() = default;
  Lamp(const Lamp&) = delete;
  Lamp& operator=(const Lamp&) = delete;

  /// Returns when it has been told so; what a screen or its cable adds is part of what is measured. Throws
  /// heel::Error.
  virtual void set(bool on) = 0;

 protected:
  Lamp() = default;
};

/// The terminal, all white or all black; afterwards it shows what it showed before. Throws heel::Error when
/// there is none.
std::unique_ptr<Lamp> terminal_lamp();

/// A file that takes a number, e.g. /sys/class/leds/NAME/brightness: the number in max_brightness beside it
/// (1 where there is none), or 0; at the end the number that it had. Throws heel::Error when it cannot be
/// written.
std::unique_ptr<Lamp> file_lamp(const std::string& path);

}  // namespace heel::cli
