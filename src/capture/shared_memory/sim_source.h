// Frames from the simulator's process over shared memory (sim_channel.h). While no simulator runs, opening
// gives Absent; when the simulator ends, is killed or restarts, waiting gives Lost, and the source can be
// opened again.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/frame_source.h"
#include "capture/shared_memory/sim_channel.h"

namespace heel {

class SimSource final : public FrameSource {
 public:
  /// Throws heel::Error for a name that a channel cannot have.
  explicit SimSource(const std::string& name);
  ~SimSource() override;

  OpenResult open() override;
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override;
  void close() override;

 private:
  OpenResult map_segment();
  OpenResult check_header();
  bool writer_is_alive() const;
  FrameResult deliver(FrameView& frame);

  std::string path_;
  int fd_ = -1;
  const SimChannelHeader* channel_ = nullptr;
  std::uint64_t mapped_bytes_ = 0;
  std::uint32_t last_published_ = 0;
  bool has_sequence_ = false;
  std::uint64_t frame_sequence_ = 0;  ///< of the last frame given
  FrameHeader header_;
  std::vector<std::uint64_t> pixels_;
};

}  // namespace heel
