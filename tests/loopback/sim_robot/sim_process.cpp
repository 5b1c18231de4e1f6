#include "sim_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <stdexcept>

namespace heel::sim::test {

double now_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void sleep_s(double seconds) {
  usleep(static_cast<useconds_t>(seconds * 1e6));
}

SimProcess::SimProcess(const std::vector<std::string>& arguments) {
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("no child process");
  if (pid_ == 0) {
    dup2(pipe_ends[1], STDOUT_FILENO);
    dup2(pipe_ends[1], STDERR_FILENO);
    std::vector<char*> argv{const_cast<char*>(HEEL_SIM_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(HEEL_SIM_PROGRAM, argv.data());
    _exit(127);
  }
  ::close(pipe_ends[1]);
  output_ = pipe_ends[0];
}

SimProcess::~SimProcess() {
  if (pid_ > 0) {
    signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  ::close(output_);
}

void SimProcess::signal(int number) const {
  if (pid_ > 0) kill(pid_, number);
}

void SimProcess::read_output(double timeout_s) {
  pollfd state{output_, POLLIN, 0};
  if (poll(&state, 1, static_cast<int>(timeout_s * 1e3)) <= 0) return;
  std::array<char, 4096> buffer{};
  const ssize_t size = read(output_, buffer.data(), buffer.size());
  if (size > 0) printed_.append(buffer.data(), static_cast<std::size_t>(size));
  if (size == 0) sleep_s(0.005);  // it has ended
}

bool SimProcess::wait_for(const std::string& text, double timeout_s) {
  const double end_s = now_s() + timeout_s;
  while (printed_.find(text) == std::string::npos) {
    if (now_s() > end_s) return false;
    read_output(0.02);
  }
  return true;
}

int SimProcess::wait_for_exit(double timeout_s) {
  const double end_s = now_s() + timeout_s;
  while (now_s() < end_s) {
    read_output(0.02);
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) continue;
    pid_ = -1;
    read_output(0.02);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  return -1;
}

}  // namespace heel::sim::test
