// How far long work is, on standard error while that is a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace heel::commandline {

/// "drawing: 120 of 800, about 40 s left", in one line that is drawn again and again, and is gone at the end.
/// Nothing is shown of work that ends at once.
class Progress {
 public:
  /// `of`: 0 when it is not known. `wanted` false: nothing is shown.
  explicit Progress(std::string what, std::uint64_t of = 0, bool wanted = true);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// From any thread.
  void show(std::uint64_t done, std::uint64_t of);
  void show(std::uint64_t done) { show(done, of_); }
  /// Frees the line for other text.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  const std::string what_;
  const std::uint64_t of_;
  const bool shown_;
  const Clock::time_point begin_;
  std::mutex mutex_;
  Clock::time_point last_;  // guarded by mutex_
  bool drawn_ = false;      // guarded by mutex_
};

/// "frames: 10 of 40, about 3 min left". The time is left out in the first second, in which it is not known.
std::string progress_text(const std::string& what, std::uint64_t done, std::uint64_t of, double elapsed_s);

/// Whether to colour what is written to this file descriptor: it is a terminal that is not "dumb", and the
/// variable NO_COLOR is not set (no-color.org).
bool colour_wanted(int fd);

}  // namespace heel::commandline
