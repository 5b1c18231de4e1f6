#include "telemetry/record_file.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "heel/error.h"

namespace heel {

RecordFile::RecordFile(std::string path) : path_(std::move(path)) {
  fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) throw Error(path_ + ": cannot create the recording: " + std::strerror(errno));
}

RecordFile::~RecordFile() {
  flush();
  ::close(fd_);
}

bool RecordFile::append(std::string_view piece) {
  if (waiting_.size() + piece.size() > kMaxWaitingBytes) flush();
  const bool fits = waiting_.size() + piece.size() <= kMaxWaitingBytes;
  // A large one may wait alone: what the disk does not take of it now must follow later, because a part of it
  // may be written already.
  const bool at_once = !fits && waiting_.empty() && !failing_;
  if (!fits && !at_once) {
    ++pieces_lost_;
    return false;
  }
  waiting_.append(piece);
  if (at_once) {
    flush();
    waiting_.shrink_to_fit();
  }
  return true;
}

/// What is written to a file without a name is lost, and fills the disk until the end of the run.
bool RecordFile::deleted() const {
  struct stat facts {};
  return ::fstat(fd_, &facts) == 0 && facts.st_nlink == 0;
}

void RecordFile::flush() {
  std::size_t written = 0;
  int error = deleted() ? ENOENT : 0;
  while (written < waiting_.size() && error == 0) {
    const ssize_t n = ::write(fd_, waiting_.data() + written, waiting_.size() - written);
    if (n > 0) {
      written += static_cast<std::size_t>(n);
    } else {
      error = n < 0 ? errno : ENOSPC;
      if (error == EINTR) error = 0;
    }
  }
  // The rest of a piece that was written in part stays first, so that the next flush completes it.
  waiting_.erase(0, written);
  report(error);
}

void RecordFile::sync() {
  flush();
  // EINVAL: not a disk; there is nothing to wait for.
  if (!failing_ && ::fdatasync(fd_) != 0 && errno != EINVAL && errno != EINTR) report(errno);
}

void RecordFile::report(int error) {
  if (error != 0 && !failing_) {
    spdlog::error("recording {}: cannot write: {}; recording continues when it can be written again", path_,
                  std::strerror(error));
  } else if (error == 0 && failing_) {
    spdlog::warn("recording {}: can be written again; {} pieces were lost", path_, pieces_lost_);
  }
  failing_ = error != 0;
}

}  // namespace heel
