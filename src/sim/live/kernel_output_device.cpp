#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "sim/live/v4l2_sink.h"

namespace heel::sim {
namespace {

class KernelOutputDevice final : public OutputDevice {
 public:
  KernelOutputDevice() = default;
  KernelOutputDevice(const KernelOutputDevice&) = delete;
  KernelOutputDevice& operator=(const KernelOutputDevice&) = delete;
  ~KernelOutputDevice() override {
    if (fd_ >= 0) ::close(fd_);
  }

  int open(const std::string& path) override {
    // An ordinary file with this name must not be overwritten.
    struct stat file {};
    if (stat(path.c_str(), &file) != 0) return errno;
    if (!S_ISCHR(file.st_mode)) return ENOTTY;
    fd_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    return fd_ < 0 ? errno : 0;
  }

  int control(unsigned long request, void* argument) override {
    while (ioctl(fd_, request, argument) != 0)
      if (errno != EINTR) return errno;
    return 0;
  }

  std::ptrdiff_t write(const std::uint8_t* bytes, std::size_t count) override {
    while (true) {
      const ssize_t taken = ::write(fd_, bytes, count);
      if (taken >= 0) return taken;
      if (errno != EINTR) return -errno;
    }
  }

 private:
  int fd_ = -1;
};

}  // namespace

std::unique_ptr<OutputDevice> make_kernel_output_device() {
  return std::make_unique<KernelOutputDevice>();
}

}  // namespace heel::sim
