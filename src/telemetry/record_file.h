// A file to which whole pieces are appended. When the disk is full or gone, it logs one error, keeps waiting
// pieces in memory as far as they fit, continues when it can write again, and leaves no partial piece.
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

  /// Adds a piece to the next flush, or flushes before when too much is waiting. A piece that is larger than
  /// what may wait is written at once when the disk works. False: that did not help; the piece was dropped
  /// and counted.
  bool append(std::string_view piece);
  /// Writes all waiting pieces.
  void flush();
  /// The same, and waits until the disk has them: what was written is there after a power cut.
  void sync();

  const std::string& path() const { return path_; }
  std::uint64_t pieces_lost() const { return pieces_lost_; }
  bool failing() const { return failing_; }

  static constexpr std::size_t kMaxWaitingBytes = 4 << 20;

 private:
  void report(int error);
  bool deleted() const;

  std::string path_;
  int fd_ = -1;
  std::string waiting_;
  bool failing_ = false;
  std::uint64_t pieces_lost_ = 0;
};

}  // namespace heel
