#include "files/natural_order.h"

#include <cstddef>

namespace heel {

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Takes the run of digits at the front of `text`, without its leading zeros.
std::string_view take_number(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && is_digit(text[end])) ++end;
  std::size_t begin = 0;
  while (begin + 1 < end && text[begin] == '0') ++begin;
  const std::string_view number = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return number;
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  const std::size_t a_size = a.size();
  const std::size_t b_size = b.size();
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view a_number = take_number(a);
      const std::string_view b_number = take_number(b);
      if (a_number.size() != b_number.size()) return a_number.size() < b_number.size();
      if (a_number != b_number) return a_number < b_number;
    } else {
      const auto a_byte = static_cast<unsigned char>(a.front());
      const auto b_byte = static_cast<unsigned char>(b.front());
      if (a_byte != b_byte) return a_byte < b_byte;
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return a_size < b_size;
}

}  // namespace heel
