// The bytes a client sends to the robot, as text: a line "SECONDS HEX" for each piece.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "files/output_file.h"
#include "heel/time.h"

namespace heel::sim {

class WireFile {
 public:
  /// `decimals` of the seconds. Throws heel::Error naming the file when it cannot be written; so do the
  /// others.
  WireFile(const std::string& path, int decimals) : file_(path), decimals_(decimals) {}

  void write(TimeNs t_ns, std::span<const std::uint8_t> bytes);
  void flush() { file_.flush(); }

 private:
  OutputFile file_;
  int decimals_;
};

}  // namespace heel::sim
