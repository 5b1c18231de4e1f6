// Frames from the simulator's process over shared memory (capture/sim_channel.h). Survives a simulator that
// is not there yet (Absent), ends, is killed, or is started again (Lost; open again).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/frame_source.h"
#include "capture/shared_memory/sim_channel.h"

namespace heel {

class SimSource final : public FrameSource {
 public:
  /// Throws heel::Error on a name no channel can have.
  explicit SimSource(const std::string& name);
  ~SimSource() override;

  OpenResult open() override;
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override;
  void close() override;

 private:
  OpenResult map_segment();
  OpenResult check_header();
  bool writer_lives() const;
  FrameResult deliver(FrameView& frame);

  std::string path_;
  int fd_ = -1;
  const SimChannelHeader* channel_ = nullptr;
  std::uint64_t mapped_bytes_ = 0;
  std::uint32_t last_published_ = 0;
  bool has_sequence_ = false;
  std::uint64_t frame_sequence_ = 0;  ///< of the frame given last
  FrameHeader header_;
  std::vector<std::uint64_t> pixels_;
};

}  // namespace heel
