#include "bench_load.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <functional>

#include "operator_client.h"
#include "realtime/clock.h"

namespace heel::cli {
namespace {

constexpr int kWatchers = 5;
constexpr TimeNs kMarkPeriod_ns = 50 * kNsPerMs;  // every second one is a `set` as well
constexpr std::size_t kWrittenBytes = 4 << 20;
constexpr int kPacketsAtOnce = 20;
constexpr double kAnswer_s = 10.0;

}  // namespace

BenchLoad::BenchLoad(const std::string& folder, const std::string& socket) {
  threads_.emplace_back([this] { keep_core_busy(); });
  threads_.emplace_back([this, file = folder + "/noise"] { write_to_disk(file); });
  threads_.emplace_back([this] { send_packets(); });
  threads_.emplace_back([this, socket] { set_and_mark(socket); });
  for (int i = 0; i < kWatchers; ++i) threads_.emplace_back([this, socket] { watch(socket); });
}

BenchLoad::~BenchLoad() {
  stop_ = true;
  for (std::thread& thread : threads_) thread.join();
}

void BenchLoad::keep_core_busy() {
  volatile std::uint64_t count = 0;
  while (!stop_) count = count + 1;
}

void BenchLoad::write_to_disk(const std::string& file) {
  const std::vector<char> bytes(kWrittenBytes, 'x');
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  while (fd >= 0 && !stop_ && pwrite(fd, bytes.data(), bytes.size(), 0) > 0) fdatasync(fd);
  if (fd >= 0) close(fd);
}

/// To the port that nobody serves: the kernel sends and refuses each.
void BenchLoad::send_packets() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(9);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const std::array<char, 1200> packet{};
  while (fd >= 0 && !stop_) {
    for (int i = 0; i < kPacketsAtOnce; ++i)
      sendto(fd, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&address),
             sizeof address);
    sleep_until_ns(monotonic_now_ns() + kNsPerMs);
  }
  if (fd >= 0) close(fd);
}

void BenchLoad::set_and_mark(const std::string& socket) {
  try {
    OperatorClient client({.socket = socket}, "bench control");
    for (int i = 0; !stop_; ++i) {
      client.ask({{"do", "mark"}, {"text", "load"}}, kAnswer_s);
      if (i % 2 == 0) {
        client.ask({{"do", "set"}, {"values", {{"control.gain_yaw_1_s", i % 4 == 0 ? 0.8 : 0.82}}}},
                   kAnswer_s);
        ++sets_;
      }
      sleep_until_ns(monotonic_now_ns() + kMarkPeriod_ns);
    }
  } catch (const CLI::RuntimeError&) {
    // heeld has ended: who measures it finds that out.
  }
}

void BenchLoad::watch(const std::string& socket) {
  try {
    OperatorClient client({.socket = socket}, "bench control");
    client.send({{"do", "watch"}, {"period_s", 0.1}});
    while (!stop_)
      if (!client.next(0.5).is_null()) ++watched_;
  } catch (const CLI::RuntimeError&) {
    // The same.
  }
}

}  // namespace heel::cli
