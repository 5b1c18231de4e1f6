#include "telemetry/record_file.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "heel/error.h"

namespace heel {

RecordFile::RecordFile(std::string path) : path_(std::move(path)) {
  fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) throw Error(path_ + ": cannot create the recording: " + std::strerror(errno));
  waiting_.reserve(kMaxWaitingBytes);
}

RecordFile::~RecordFile() {
  flush();
  ::close(fd_);
}

void RecordFile::append(std::string_view line) {
  if (waiting_.size() + line.size() > kMaxWaitingBytes) {
    ++lines_lost_;
    return;
  }
  waiting_.append(line);
}

void RecordFile::flush() {
  std::size_t written = 0;
  int error = 0;
  while (written < waiting_.size() && error == 0) {
    const ssize_t n = ::write(fd_, waiting_.data() + written, waiting_.size() - written);
    if (n > 0) {
      written += static_cast<std::size_t>(n);
    } else {
      error = n < 0 ? errno : ENOSPC;
      if (error == EINTR) error = 0;
    }
  }
  // The rest of a line that was written in part stays first, so that the next flush completes it.
  waiting_.erase(0, written);
  if (error != 0 && !failing_) {
    spdlog::error("recording {}: cannot write: {}; recording continues when it can be written again", path_,
                  std::strerror(error));
  } else if (error == 0 && failing_) {
    spdlog::warn("recording {}: can be written again; {} lines were lost", path_, lines_lost_);
  }
  failing_ = error != 0;
}

}  // namespace heel
