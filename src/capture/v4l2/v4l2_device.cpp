#include "capture/v4l2/v4l2_device.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

namespace heel {

namespace {

class KernelV4l2Device final : public V4l2Device {
 public:
  KernelV4l2Device() = default;
  KernelV4l2Device(const KernelV4l2Device&) = delete;
  KernelV4l2Device& operator=(const KernelV4l2Device&) = delete;
  ~KernelV4l2Device() override { KernelV4l2Device::close(); }

  int open(const std::string& path) override {
    close();
    // Non-blocking: dequeuing never sleeps; only wait_readable() sleeps, with a timeout.
    fd_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (fd_ < 0) return errno;
    struct stat file {};
    if (fstat(fd_, &file) == 0 && S_ISCHR(file.st_mode)) return 0;
    close();
    return ENOTTY;
  }

  void close() override {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

  int control(unsigned long request, void* argument) override {
    while (ioctl(fd_, request, argument) != 0) {
      if (errno != EINTR) return errno;
    }
    return 0;
  }

  void* map(std::size_t bytes, std::int64_t offset) override {
    // Some drivers require a writable mapping even for capture.
    void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, offset);
    return memory == MAP_FAILED ? nullptr : memory;
  }

  void unmap(void* memory, std::size_t bytes) override { munmap(memory, bytes); }

  PollResult wait_readable(TimeNs timeout_ns) override {
    pollfd waited{.fd = fd_, .events = POLLIN, .revents = 0};
    const timespec timeout{.tv_sec = timeout_ns / kNsPerS, .tv_nsec = timeout_ns % kNsPerS};
    const int ready = ppoll(&waited, 1, &timeout, nullptr);
    if (ready > 0) return (waited.revents & POLLNVAL) != 0 ? PollResult::Failed : PollResult::Ready;
    return ready == 0 || errno == EINTR ? PollResult::Timeout : PollResult::Failed;
  }

 private:
  int fd_ = -1;
};

}  // namespace

std::unique_ptr<V4l2Device> make_kernel_v4l2_device() {
  return std::make_unique<KernelV4l2Device>();
}

}  // namespace heel
