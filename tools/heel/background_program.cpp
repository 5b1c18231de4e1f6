#include "background_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "heel/error.h"
#include "realtime/clock.h"

namespace heel::cli {
namespace {

constexpr TimeNs kPoll_ns = 20 * kNsPerMs;
constexpr TimeNs kEndTimeout_ns = 5 * kNsPerS;
constexpr std::size_t kShownBytes = 600;

}  // namespace

BackgroundProgram::BackgroundProgram(const std::vector<std::string>& arguments, std::string log_file)
    : name_(std::filesystem::path(arguments.front()).filename()), log_file_(std::move(log_file)) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_addopen(&streams, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&streams, STDOUT_FILENO, log_file_.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&streams, STDOUT_FILENO, STDERR_FILENO);
  const int error = posix_spawn(&pid_, argv[0], &streams, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  if (error != 0) throw Error(arguments.front() + ": cannot be started: " + std::strerror(error));
}

BackgroundProgram::~BackgroundProgram() {
  if (ended_) return;
  kill(pid_, SIGTERM);
  for (const TimeNs end_ns = monotonic_now_ns() + kEndTimeout_ns; monotonic_now_ns() < end_ns;) {
    if (waitpid(pid_, nullptr, WNOHANG) == pid_) return;
    sleep_until_ns(monotonic_now_ns() + kPoll_ns);
  }
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

std::string BackgroundProgram::output() const {
  std::ifstream file(log_file_, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void BackgroundProgram::wait_for(const std::string& text, double timeout_s) {
  const TimeNs end_ns = monotonic_now_ns() + ns_from_seconds(timeout_s);
  while (output().find(text) == std::string::npos) {
    require_running();
    if (monotonic_now_ns() > end_ns) fail("has not printed '" + text + "' in time");
    sleep_until_ns(monotonic_now_ns() + kPoll_ns);
  }
}

void BackgroundProgram::wait_for_end(double timeout_s) {
  int status = 0;
  for (const TimeNs end_ns = monotonic_now_ns() + ns_from_seconds(timeout_s); monotonic_now_ns() < end_ns;) {
    if (waitpid(pid_, &status, WNOHANG) != pid_) {
      sleep_until_ns(monotonic_now_ns() + kPoll_ns);
      continue;
    }
    ended_ = true;
    if (status != 0) fail("has failed");
    return;
  }
  fail("has not ended in time");
}

void BackgroundProgram::require_running() {
  ended_ = ended_ || waitpid(pid_, nullptr, WNOHANG) == pid_;
  if (ended_) fail("has ended early");
}

void BackgroundProgram::fail(const std::string& what) const {
  std::string end = output();
  if (end.size() > kShownBytes) end.erase(0, end.size() - kShownBytes);
  throw Error(name_ + ": " + what + "; the end of its output:\n" + end);
}

}  // namespace heel::cli
