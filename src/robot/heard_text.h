// What a line says that does not speak ARCOS: a GPS receiver, a microcontroller's log, the banner of another
// service. Fixed memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace heel {

class HeardText {
 public:
  void clear() { *this = {}; }

  /// Bytes as they came at one rate.
  void hear(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) {
      const bool printable = byte >= ' ' && byte <= '~';
      const bool ends_line = byte == '\r' || byte == '\n';
      ++bytes_;
      text_bytes_ += printable || ends_line || byte == '\t' ? 1 : 0;
      if (ends_line && size_ < kLeast) size_ = 0;  // a longer line may follow
      if (ends_line && size_ >= kLeast) complete_ = true;
      // Braces would be taken for placeholders of a message.
      if (printable && !complete_ && size_ < chars_.size())
        chars_[size_++] = byte == '{' ? '(' : byte == '}' ? ')' : static_cast<char>(byte);
    }
  }

  std::uint64_t bytes() const { return bytes_; }
  /// A whole line of it, and next to nothing else: it is not waited for more.
  bool is_clear() const {
    return complete_ && bytes_ >= kClear && text_bytes_ * 20 >= bytes_ * 19 && !text().empty();
  }
  /// The first line of some length; empty when what was heard is no text.
  std::string_view text() const {
    const bool is_text = size_ >= kLeast && text_bytes_ * 10 >= bytes_ * 9;
    return is_text ? std::string_view(chars_.data(), size_) : std::string_view();
  }

 private:
  static constexpr std::size_t kLeast = 8;
  static constexpr std::uint64_t kClear = 20;

  std::array<char, 40> chars_{};
  std::size_t size_ = 0;
  bool complete_ = false;
  std::uint64_t bytes_ = 0, text_bytes_ = 0;
};

}  // namespace heel
