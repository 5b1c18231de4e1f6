// What a client sends, as text: one line a piece, "seconds hex", as `heel simulate --out` writes wire.hex.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "heel/time.h"

namespace heel::sim {

class WireFile {
 public:
  /// Throws heel::Error when the file cannot be written.
  explicit WireFile(const std::string& path);

  /// Whole lines are on disk at once, so that the file can be read while the robot runs.
  void write(TimeNs t_ns, std::span<const std::uint8_t> bytes);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace heel::sim
