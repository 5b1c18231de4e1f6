// Questions to the person who sets heel up: on a terminal, by lines of standard input, or by the usual
// answers.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include "heel/error.h"

namespace heel::cli {

/// Nobody is there who answers.
class NoAnswer : public Error {
 public:
  using Error::Error;
};

/// Thrown when the person ends the set-up by a signal.
struct SetupInterrupted {};

class Dialogue {
 public:
  /// `usual_answers`: a question with a usual answer is not asked. `out` gets all text, and must outlive
  /// this.
  Dialogue(bool usual_answers, std::ostream& out);

  void say(const std::string& line);
  /// A line; the usual answer for an empty one. Where there is no answer: throws NoAnswer, which names the
  /// option that would give it. Throws SetupInterrupted.
  std::string ask(const std::string& question, const std::string& usual, const std::string& option);
  /// Asks until `take` accepts the answer; it gives what was expected, or nothing.
  void ask_until(const std::string& question, const std::string& usual, const std::string& option,
                 const std::function<std::string(const std::string& answer)>& take);
  bool yes(const std::string& question, bool usual, const std::string& option);
  /// Whether the person has typed this very word. There is no usual answer to what moves the robot.
  bool consents(const std::string& question, const std::string& word);

  bool at_terminal() const { return at_terminal_; }
  /// Of a person at a terminal, since the last question.
  bool enter_pressed();

 private:
  enum class Line { Read, Ended };
  Line read_line(std::string& line);
  bool wait_readable(int timeout_ms);

  const bool usual_answers_;
  std::ostream& out_;
  const bool at_terminal_;
  std::string unread_;
};

/// Waits so long, and says each second how many are left. Throws SetupInterrupted.
void count_down(Dialogue& dialogue, double seconds);

}  // namespace heel::cli
