// The token that a browser must know to change anything.
#pragma once

#include <string>
#include <string_view>

namespace heel {

class Token {
 public:
  /// There is none: nothing equals it.
  Token() = default;
  /// Of the file, or, when its name is empty, of the systemd credential "view-token"; none when that is
  /// missing, too. White space at the end is no part of it. Throws heel::Error naming the file when it cannot
  /// be read, when other users can, or when it is too short or too long.
  static Token read(const std::string& file);

  bool set() const { return !text_.empty(); }
  /// Takes the same time for every text of one length.
  bool equals(std::string_view text) const;

 private:
  std::string text_;
};

}  // namespace heel
