// Frames into a V4L2 output device, such as v4l2loopback makes, so that every program that reads a camera can
// read the simulated one. The format is YUYV without colour, which every reader understands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/live/frame_sink.h"

namespace heel::sim {

/// The system calls that the sink makes; tests put their own device in the kernel's place.
class OutputDevice {
 public:
  virtual ~OutputDevice() = default;
  /// 0 or errno.
  virtual int open(const std::string& path) = 0;
  /// ioctl(2). 0 or errno.
  virtual int control(unsigned long request, void* argument) = 0;
  /// write(2). The number of bytes taken, or −errno.
  virtual std::ptrdiff_t write(const std::uint8_t* bytes, std::size_t count) = 0;
};
std::unique_ptr<OutputDevice> make_kernel_output_device();

class V4l2Sink : public FrameSink {
 public:
  /// Throws heel::Error naming the path when there is no such device, or one that is not a video device,
  /// accepts no frames or not this size.
  V4l2Sink(std::unique_ptr<OutputDevice> device, const std::string& path, int width_px, int height_px,
           double rate_hz);

  void put(const FrameView& frame) override;

 private:
  void check_device();
  void set_format(int width_px, int height_px);
  void set_rate(double rate_hz);
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const;

  std::unique_ptr<OutputDevice> device_;
  std::string path_;
  std::vector<std::uint8_t> yuyv_;
};

}  // namespace heel::sim
