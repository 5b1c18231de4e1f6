#include "terminal.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string_view>

namespace heel::cli {
namespace {

volatile std::sig_atomic_t screen_ended = 0;

void end_screen(int) {
  screen_ended = 1;
}

void write_all(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(STDOUT_FILENO, text.data(), text.size());
    if (count <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

constexpr std::string_view kHideCursor = "\x1b[?25l", kShowCursor = "\x1b[?25h";
constexpr std::string_view kClear = "\x1b[2J", kHome = "\x1b[H", kClearLine = "\x1b[K",
                           kClearBelow = "\x1b[J";

}  // namespace

bool is_screen() {
  const char* const kind = std::getenv("TERM");
  return isatty(STDIN_FILENO) == 1 && isatty(STDOUT_FILENO) == 1 && kind != nullptr &&
         std::string_view(kind) != "dumb";
}

Screen::Screen() {
  tcgetattr(STDIN_FILENO, &before_);
  termios keys = before_;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 0;
  keys.c_cc[VTIME] = 0;
  tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  struct sigaction action {};
  action.sa_handler = end_screen;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
  write_all(std::string(kHideCursor) + std::string(kClear));
}

Screen::~Screen() {
  write_all(kShowCursor);
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

Screen::Size Screen::size() const {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return {};
  return {size.ws_col, size.ws_row};
}

void Screen::draw(const std::vector<std::string>& lines) {
  // In one piece, so that no half of it is seen. The last row stays free for the cursor.
  std::string out(kHome);
  const std::size_t most = static_cast<std::size_t>(size().rows) - 1;
  for (std::size_t i = 0; i < lines.size() && i < most; ++i)
    out.append(lines[i]).append(kClearLine).append("\r\n");
  write_all(out.append(kClearBelow));
}

char Screen::key() const {
  pollfd readable{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  if (poll(&readable, 1, 0) <= 0) return 0;
  return read(STDIN_FILENO, &key, 1) == 1 ? key : '\0';
}

bool Screen::ended() const {
  return screen_ended != 0;
}

}  // namespace heel::cli
