#include "operator/line_buffer.h"

#include <algorithm>
#include <utility>

namespace heel {

void LineBuffer::feed(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t newline = bytes.find('\n');
    if (newline == std::string_view::npos) {
      append(bytes);
      return;
    }
    append(bytes.substr(0, newline));
    if (partial_.ends_with('\r')) partial_.pop_back();
    if (!partial_.empty()) lines_.push_back(std::move(partial_));
    partial_.clear();
    bytes.remove_prefix(newline + 1);
  }
}

void LineBuffer::append(std::string_view bytes) {
  // One for a byte too many, one for the carriage return that a line of the allowed length may end with.
  const std::size_t room = max_line_bytes_ + 2 - std::min(partial_.size(), max_line_bytes_ + 2);
  partial_.append(bytes.substr(0, room));
}

bool LineBuffer::take(std::string& line) {
  if (lines_.empty()) return false;
  line = std::move(lines_.front());
  lines_.pop_front();
  return true;
}

}  // namespace heel
