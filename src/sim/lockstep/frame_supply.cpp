#include "sim/lockstep/frame_supply.h"

#include "capture/factory/frame_source_factory.h"
#include "core/config.h"
#include "core/picture_turn.h"
#include "heel/error.h"

namespace heel::sim {
namespace {

FrameHeader header_of(std::uint64_t sequence, TimeNs t_ns, std::uint32_t width_px, std::uint32_t height_px) {
  FrameHeader header;
  header.sequence = sequence;
  header.t_capture_ns = t_ns;
  header.width_px = width_px;
  header.height_px = height_px;
  return header;
}

class WorldSupply : public FrameSupply {
 public:
  explicit WorldSupply(World& world) : world_(world), turner_(world.scenario().camera.turn.inverse()) {}

  FrameView frame(std::uint64_t sequence, TimeNs t_ns, const RobotMotion& robot) override {
    world_.render(robot, seconds_from_ns(t_ns), sequence, grey_);
    const CameraModel& camera = world_.scenario().camera.model;
    const auto width_px = static_cast<std::uint32_t>(camera.width_px);
    return turner_.of({header_of(sequence, t_ns, width_px, static_cast<std::uint32_t>(camera.height_px)),
                       grey_.data(), width_px});
  }

 private:
  World& world_;
  PictureTurner turner_;  ///< upright → as the camera sends it
  std::vector<std::uint8_t> grey_;
};

class FileSupply : public FrameSupply {
 public:
  FileSupply(const std::string& source, int width_px, int height_px) {
    CameraConfig config;
    config.source = source;
    config.width_px = width_px;
    config.height_px = height_px;
    config.file_speed = 0.0;  // each frame when it is requested: lock step has its own time
    source_ = open_frame_source(config);
  }

  /// Frames get their time in the virtual run; a damaged frame is skipped like a lost one.
  FrameView frame(std::uint64_t sequence, TimeNs t_ns, const RobotMotion& /*robot*/) override {
    FrameView view;
    FrameResult result = FrameResult::Error;
    while (result == FrameResult::Error || result == FrameResult::Timeout)
      result = source_->wait_frame(kNsPerS, view);
    if (result != FrameResult::Frame) return {};
    view.header = header_of(sequence, t_ns, view.header.width_px, view.header.height_px);
    return view;
  }

 private:
  std::unique_ptr<FrameSource> source_;
};

}  // namespace

std::unique_ptr<FrameSupply> make_world_supply(World& world) {
  return std::make_unique<WorldSupply>(world);
}

std::unique_ptr<FrameSupply> make_file_supply(const std::string& source, int width_px, int height_px) {
  return std::make_unique<FileSupply>(source, width_px, height_px);
}

}  // namespace heel::sim
