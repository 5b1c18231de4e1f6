// A terminal that shows one view in place of lines: keys without Enter, a hidden cursor, and each drawing
// over the last.
#pragma once

#include <termios.h>

#include <string>
#include <vector>

namespace heel::cli {

/// Whether people see what is written: both ends are a terminal that can place its cursor.
bool is_screen();

/// While it exists, the terminal is its own; afterwards it is as before, with the last view on it. SIGINT,
/// SIGTERM and SIGHUP end the view and not the program: see ended().
class Screen {
 public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  struct Size {
    int columns = 80;
    int rows = 24;
  };
  Size size() const;
  /// Draws the lines over the last ones; those that do not fit into the height are left out.
  void draw(const std::vector<std::string>& lines);
  /// A key that has been pressed; 0: none.
  char key() const;
  bool ended() const;

 private:
  termios before_{};
};

}  // namespace heel::cli
