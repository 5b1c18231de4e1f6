#include "support/process.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "support/temporary_folder.h"

namespace heel::test {

void sleep_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

double monotonic_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

namespace {

/// In a child process: becomes the program `argv`.
void execute(const std::vector<std::string>& argv, const std::map<std::string, std::string>& environment) {
  std::vector<char*> arguments;
  for (const auto& argument : argv) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  unsetenv("NOTIFY_SOCKET");
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  execv(arguments[0], arguments.data());
  _exit(127);
}

/// In a child process: `path` in place of the standard stream `stream`.
void redirect(int stream, const std::string& path) {
  const int flags = stream == STDIN_FILENO ? O_RDONLY : O_WRONLY | O_CREAT | O_TRUNC;
  const int file = open(path.c_str(), flags, 0644);
  if (file < 0) _exit(126);
  dup2(file, stream);
  close(file);
}

}  // namespace

Process::Process(const std::vector<std::string>& argv, const std::string& log_path,
                 const std::map<std::string, std::string>& environment)
    : log_path_(log_path), log_is_ours_(log_path.empty()) {
  start([&] { execute(argv, environment); });
}

Process::Process(const std::function<void()>& body) : log_is_ours_(true) {
  start(body);
}

void Process::start(const std::function<void()>& body) {
  if (log_is_ours_) log_path_ = std::filesystem::temp_directory_path() / "heel-test-XXXXXX";
  const int log = log_is_ours_ ? mkostemp(log_path_.data(), O_CLOEXEC)
                               : open(log_path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (log < 0) throw std::runtime_error("cannot write " + log_path_);
  pid_ = fork();
  if (pid_ == 0) {
    redirect(STDIN_FILENO, "/dev/null");
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    body();
    _exit(0);
  }
  close(log);
}

Process::~Process() {
  if (running()) signal(SIGKILL);
  wait();
  if (log_is_ours_) unlink(log_path_.c_str());
}

void Process::signal(int number) const {
  if (!ended_) kill(pid_, number);
}

bool Process::running() {
  if (!ended_ && waitpid(pid_, &status_, WNOHANG) == pid_) ended_ = true;
  return !ended_;
}

int Process::wait(double timeout_s) {
  if (!eventually([this] { return !running(); }, timeout_s)) return -1000;
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
}

std::string Process::output() const {
  return read_text(log_path_);
}

bool Process::says(const std::string& text, double timeout_s) {
  bool found = false;
  eventually(
      [&] {
        const bool ended = !running();  // before reading: the output of an ended process is then complete
        found = output().find(text) != std::string::npos;
        return found || ended;
      },
      timeout_s);
  return found;
}

std::string built_program(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

Outcome run_program(const std::vector<std::string>& argv, const std::string& out_path) {
  const TemporaryFolder folder;
  const std::string out = out_path.empty() ? folder.file("out") : out_path;
  const std::string err = folder.file("err");
  Process process([&] {
    redirect(STDOUT_FILENO, out);
    redirect(STDERR_FILENO, err);
    execute(argv, {});
  });
  Outcome outcome;
  outcome.status = process.wait(kProgramPatience_s);
  if (out_path.empty()) outcome.out = read_text(out);
  outcome.err = read_text(err);
  return outcome;
}

NotifySocket::NotifySocket(const std::string& path) : path_(path) {
  fd_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  if (bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("cannot bind " + path);
  }
  reader_ = std::thread([this] { read_until_closed(); });
}

NotifySocket::~NotifySocket() {
  shutdown(fd_, SHUT_RDWR);  // ends the reader's recv
  reader_.join();
  close(fd_);
}

void NotifySocket::read_until_closed() {
  char text[4096];
  for (ssize_t size; (size = recv(fd_, text, sizeof text, 0)) > 0;) {
    const std::scoped_lock lock(mutex_);
    messages_.emplace_back(text, static_cast<std::size_t>(size));
  }
}

std::vector<std::string> NotifySocket::messages() {
  const std::scoped_lock lock(mutex_);
  return messages_;
}

bool NotifySocket::receives(const std::string& text, double timeout_s) {
  return eventually(
      [&] {
        for (const auto& message : messages()) {
          if (message.find(text) != std::string::npos) return true;
        }
        return false;
      },
      timeout_s);
}

}  // namespace heel::test
