// A file to which whole lines are appended. When the disk is full, it logs one error, keeps waiting lines in
// memory as far as they fit, continues when there is space again, and leaves no partial line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace heel {

class RecordFile {
 public:
  /// Creates the file. Throws heel::Error, which names it, when that fails or the file exists.
  explicit RecordFile(std::string path);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  /// Adds a line (with its line end) to the next flush. When too much is waiting, the line is dropped and
  /// counted.
  void append(std::string_view line);
  /// Writes all waiting lines.
  void flush();

  const std::string& path() const { return path_; }
  std::uint64_t lines_lost() const { return lines_lost_; }

  static constexpr std::size_t kMaxWaitingBytes = 1 << 20;

 private:
  std::string path_;
  int fd_ = -1;
  std::string waiting_;
  bool failing_ = false;
  std::uint64_t lines_lost_ = 0;
};

}  // namespace heel
