#include "files/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "heel/error.h"

namespace heel {
namespace {

Error file_error(const std::string& path, const std::string& what) {
  return Error(path + ": " + what + ": " + std::strerror(errno));
}

/// The file that `path` leads to: a symbolic link stays one, and what it links to is replaced. Throws for
/// what is no ordinary file: it would be gone.
std::string file_behind(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 8;
  fs::path file = path;
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(file, error)); ++i)
    file = file.parent_path() / fs::read_symlink(file, error);
  const fs::file_status status = fs::status(file, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw Error(path + ": cannot write: it is a " + (fs::is_directory(status) ? "folder" : "device or pipe") +
                " (expected the name of a file)");
  return file.string();
}

/// A new file beside the final one; removed at the end unless it was renamed to it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& final_path)
      : path_(final_path + ".XXXXXX"), fd_(mkstemp(path_.data())) {
    if (fd_ < 0) throw file_error(final_path, "cannot write beside it");
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (fd_ >= 0) close(fd_);
    if (!renamed_) unlink(path_.c_str());
  }

  bool write_all(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }
  /// The permissions of the file that is replaced, or of an ordinary new file; mkstemp gives 0600.
  bool set_mode(const std::string& final_path) const {
    struct stat replaced {};
    if (stat(final_path.c_str(), &replaced) == 0 && S_ISREG(replaced.st_mode)) {
      // Its group as well, where this process may give it; otherwise the group may what everybody may.
      const bool group_kept = fchown(fd_, static_cast<uid_t>(-1), replaced.st_gid) == 0;
      const mode_t everybodys = (replaced.st_mode & 07u) << 3u;
      return fchmod(fd_, replaced.st_mode & (group_kept ? 0777u : 0707u | everybodys)) == 0;
    }
    const mode_t mask = umask(0);
    umask(mask);
    return fchmod(fd_, 0666 & ~mask) == 0;
  }
  bool sync() const { return fsync(fd_) == 0; }
  bool rename_to(const std::string& final_path) {
    renamed_ = std::rename(path_.c_str(), final_path.c_str()) == 0;
    return renamed_;
  }

 private:
  std::string path_;
  int fd_;
  bool renamed_ = false;
};

/// Makes the rename itself survive a power cut. A failure is ignored: some file systems do not support it,
/// and the data is safe anyway.
void sync_folder_of(const std::string& path) {
  std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) folder = ".";
  const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

}  // namespace

void write_file_atomically(const std::string& name, std::string_view bytes) {
  const std::string path = file_behind(name);
  TemporaryFile temporary(path);
  if (!temporary.write_all(bytes) || !temporary.set_mode(path) || !temporary.sync() ||
      !temporary.rename_to(path)) {
    throw file_error(path, "cannot write");
  }
  sync_folder_of(path);
}

void require_regular_file(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    if (path.find("://") != std::string::npos)
      throw Error(path + ": cannot read an address (expected a file on this computer)");
    throw file_error(path, "cannot read");
  }
  if (!S_ISREG(status.st_mode)) throw Error(path + ": cannot read: expected a regular file");
}

std::string read_whole_file(const std::string& path, std::size_t max_bytes) {
  require_regular_file(path);
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) throw file_error(path, "cannot read");
  if (static_cast<std::size_t>(status.st_size) > max_bytes) {
    throw Error(fmt::format("{}: {} bytes (expected at most {})", path, status.st_size, max_bytes));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw file_error(path, "cannot read");
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad()) throw file_error(path, "cannot read");
  return bytes;
}

}  // namespace heel
