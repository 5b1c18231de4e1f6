#include "setup_dialogue.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "heel/error.h"
#include "preflight_step.h"
#include "realtime/clock.h"

namespace heel::cli {
namespace {

constexpr int kPoll_ms = 100;  // a signal that comes between two system calls is seen after this

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

}  // namespace

Dialogue::Dialogue(bool usual_answers, std::ostream& out)
    : usual_answers_(usual_answers), out_(out), at_terminal_(isatty(STDIN_FILENO) == 1) {}

void Dialogue::say(const std::string& line) {
  out_ << line << '\n' << std::flush;
}

bool Dialogue::wait_readable(int timeout_ms) {
  pollfd readable{STDIN_FILENO, POLLIN, 0};
  return poll(&readable, 1, timeout_ms) > 0;
}

Dialogue::Line Dialogue::read_line(std::string& line) {
  for (;;) {
    if (g_preflight_interrupted) throw SetupInterrupted();
    if (const std::size_t newline = unread_.find('\n'); newline != std::string::npos) {
      line = trimmed(unread_.substr(0, newline));
      unread_.erase(0, newline + 1);
      return Line::Read;
    }
    if (!wait_readable(kPoll_ms)) continue;
    char bytes[256];
    const ssize_t count = read(STDIN_FILENO, bytes, sizeof bytes);
    if (count <= 0) {  // a last line without its end is an answer, too
      line = trimmed(unread_);
      unread_.clear();
      return line.empty() ? Line::Ended : Line::Read;
    }
    unread_.append(bytes, static_cast<std::size_t>(count));
  }
}

std::string Dialogue::ask(const std::string& question, const std::string& usual, const std::string& option) {
  const std::string shown = usual.empty() ? question : fmt::format("{} [{}]", question, usual);
  if (usual_answers_ && !usual.empty()) {
    say(shown + ": " + usual);
    return usual;
  }
  out_ << shown << ": " << std::flush;
  std::string line;
  if (usual_answers_ || read_line(line) == Line::Ended) {
    say("");
    throw NoAnswer(
        fmt::format("no answer to '{}' (expected {} or a line on standard input)", question, option));
  }
  if (!at_terminal_) say(line);  // where nobody has typed it, it is to be read beside its question
  return line.empty() ? usual : line;
}

void Dialogue::ask_until(const std::string& question, const std::string& usual, const std::string& option,
                         const std::function<std::string(const std::string& answer)>& take) {
  for (;;) {
    const std::string answer = ask(question, usual, option);
    const std::string expected = take(answer);
    if (expected.empty()) return;
    if (usual_answers_) throw Error(fmt::format("{}: '{}' (expected {})", option, answer, expected));
    say(fmt::format("'{}' (expected {})", answer, expected));
  }
}

bool Dialogue::yes(const std::string& question, bool usual, const std::string& option) {
  bool answer_is_yes = false;
  ask_until(question, usual ? "yes" : "no", option, [&](const std::string& answer) {
    answer_is_yes = answer == "yes" || answer == "y";
    return answer_is_yes || answer == "no" || answer == "n" ? "" : "yes or no";
  });
  return answer_is_yes;
}

bool Dialogue::consents(const std::string& question, const std::string& word) {
  if (usual_answers_) return false;
  out_ << question << ": " << std::flush;
  std::string line;
  const bool answered = read_line(line) == Line::Read;
  if (!at_terminal_) say(line);
  return answered && line == word;
}

bool Dialogue::enter_pressed() {
  if (!at_terminal_ || !wait_readable(0)) return false;
  std::string line;
  return read_line(line) == Line::Read;
}

void count_down(Dialogue& dialogue, double seconds) {
  const TimeNs end_ns = monotonic_now_ns() + static_cast<TimeNs>(seconds * static_cast<double>(kNsPerS));
  for (int said = -1;;) {
    if (g_preflight_interrupted) throw SetupInterrupted();
    const TimeNs left_ns = end_ns - monotonic_now_ns();
    if (left_ns <= 0) return;
    const int left_s = static_cast<int>(std::ceil(seconds_from_ns(left_ns)));
    if (left_s != said) dialogue.say(fmt::format("  {} s", said = left_s));
    poll(nullptr, 0, static_cast<int>(std::min<TimeNs>(left_ns / kNsPerMs + 1, kPoll_ms)));
  }
}

}  // namespace heel::cli
