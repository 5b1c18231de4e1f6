// Bytes as a file that readers open by a path.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "fuzz/require.h"
#include "heel/error.h"

namespace heel::test {

class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(memfd_create("fuzz", MFD_CLOEXEC)) {
    if (fd_ < 0 || write(fd_, data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

/// Calls `read(path)` for a file of these bytes. It returns, or refuses the file in one line.
template <typename Read>
void require_read_or_refused(const std::uint8_t* data, std::size_t size, Read read) {
  const MemoryFile file(data, size);
  try {
    read(file.path());
  } catch (const Error& error) {
    require(std::string(error.what()).find('\n') == std::string::npos);
  }
}

}  // namespace heel::test
