// The interface between heel and the kernel's video devices: the few system calls that V4L2 needs. It makes
// no decisions; the code that does is tested against a scripted device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "heel/time.h"

namespace heel {

enum class PollResult : std::uint8_t { Ready, Timeout, Failed };

class V4l2Device {
 public:
  virtual ~V4l2Device() = default;

  /// 0 or errno.
  virtual int open(const std::string& path) = 0;
  virtual void close() = 0;
  /// ioctl(2), repeated when a signal interrupts it. 0 or errno.
  virtual int control(unsigned long request, void* argument) = 0;
  /// mmap(2) of `bytes` at `offset`, for reading. Null: it failed.
  virtual void* map(std::size_t bytes, std::int64_t offset) = 0;
  virtual void unmap(void* memory, std::size_t bytes) = 0;
  /// Waits for a filled buffer, or for an error, which VIDIOC_DQBUF then returns.
  virtual PollResult wait_readable(TimeNs timeout_ns) = 0;
};

/// The device by the kernel's system calls.
std::unique_ptr<V4l2Device> make_kernel_v4l2_device();

}  // namespace heel
