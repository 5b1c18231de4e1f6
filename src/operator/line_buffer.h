// Bytes of a connection → lines, bounded.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>

namespace heel {

/// A line ends with \n or \r\n. It is kept without its end; empty lines are left out. Bytes of a line beyond
/// the bound are dropped but for the first one, by which the line is seen to be too long.
class LineBuffer {
 public:
  explicit LineBuffer(std::size_t max_line_bytes) : max_line_bytes_(max_line_bytes) {}

  void feed(std::string_view bytes);
  /// True: `line` is the oldest line that is complete.
  bool take(std::string& line);
  /// Bytes have come after the last line end.
  bool has_partial_line() const { return !partial_.empty(); }

 private:
  void append(std::string_view bytes);

  std::size_t max_line_bytes_;
  std::string partial_;
  std::deque<std::string> lines_;
};

}  // namespace heel
