#include "sim/transport/wire_file.h"

#include <cerrno>
#include <cstring>

#include "heel/error.h"

namespace heel::sim {

WireFile::WireFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "w")) {
  if (!file_) throw Error("--wire " + path + ": cannot write: " + std::strerror(errno));
}

void WireFile::write(TimeNs t_ns, std::span<const std::uint8_t> bytes) {
  std::fprintf(file_.get(), "%.6f ", seconds_from_ns(t_ns));
  for (const std::uint8_t byte : bytes) std::fprintf(file_.get(), "%02x", byte);
  std::fputc('\n', file_.get());
  if (std::fflush(file_.get()) != 0)
    throw Error("--wire " + path_ + ": write failed: " + std::strerror(errno));
}

}  // namespace heel::sim
