#include "commandline/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace heel::commandline {
namespace {

constexpr std::chrono::milliseconds kDrawPeriod{200};
constexpr double kTimeKnownAfter_s = 1.0;
constexpr double kMinutesFrom_s = 90.0, kHoursFrom_s = 5400.0;

std::string duration_text(double seconds) {
  if (seconds < kMinutesFrom_s) return fmt::format("{:.0f} s", std::ceil(seconds));
  if (seconds < kHoursFrom_s) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

}  // namespace

std::string progress_text(const std::string& what, std::uint64_t done, std::uint64_t of, double elapsed_s) {
  if (of == 0) return fmt::format("{}: {}", what, done);
  std::string text = fmt::format("{}: {} of {}", what, done, of);
  if (done == 0 || done > of || elapsed_s < kTimeKnownAfter_s) return text;
  return text + fmt::format(", about {} left", duration_text(elapsed_s * static_cast<double>(of - done) /
                                                             static_cast<double>(done)));
}

Progress::Progress(std::string what, std::uint64_t of, bool wanted)
    : what_(std::move(what)),
      of_(of),
      shown_(wanted && isatty(STDERR_FILENO) == 1),
      begin_(Clock::now()),
      last_(begin_) {}

Progress::~Progress() {
  clear();
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void Progress::show(std::uint64_t done, std::uint64_t of) {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (now - last_ < kDrawPeriod) return;
  last_ = now;
  drawn_ = true;
  const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
  fmt::print(stderr, "\r{}\033[K", progress_text(what_, done, of, elapsed_s));
}

bool colour_wanted(int fd) {
  const char* no_colour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return isatty(fd) == 1 && (no_colour == nullptr || *no_colour == '\0') && terminal != nullptr &&
         std::strcmp(terminal, "dumb") != 0;
}

}  // namespace heel::commandline
