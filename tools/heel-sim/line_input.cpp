#include "line_input.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace heel::sim {

/// False: nothing more has come.
bool LineInput::read_more() {
  pollfd ready{fd_, POLLIN, 0};
  if (fd_ < 0 || poll(&ready, 1, 0) <= 0) return false;
  std::array<char, 4096> bytes{};
  const ssize_t count = read(fd_, bytes.data(), bytes.size());
  if (count <= 0) {
    if (count == 0 || errno != EINTR) fd_ = -1;
    return false;
  }
  rest_.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

std::vector<std::string> LineInput::lines() {
  while (read_more()) {
  }
  std::vector<std::string> complete;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = rest_.find('\n', begin)) != std::string::npos; begin = end + 1)
    if (end > begin) complete.push_back(rest_.substr(begin, end - begin));
  rest_.erase(0, begin);
  return complete;
}

}  // namespace heel::sim
