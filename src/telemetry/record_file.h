// A file that whole lines are appended to, and that outlives a full disk: it says so once, keeps what it can,
// goes on when there is room again, and never leaves half a line behind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace heel {

class RecordFile {
 public:
  /// Creates the file; throws heel::Error naming it when that fails or it exists.
  explicit RecordFile(std::string path);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  /// Keeps a line (with its line end) for the next flush. Lost, and counted, when too much is waiting.
  void append(std::string_view line);
  /// Writes what is waiting.
  void flush();

  const std::string& path() const { return path_; }
  std::uint64_t lines_lost() const { return lines_lost_; }

  static constexpr std::size_t kMostWaitingBytes = 1 << 20;

 private:
  std::string path_;
  int fd_ = -1;
  std::string waiting_;
  bool failing_ = false;
  std::uint64_t lines_lost_ = 0;
};

}  // namespace heel
