// What else a robot computer does while heeld drives, all at once: for heel bench control.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace heel::cli {

class BenchLoad {
 public:
  /// Starts, in threads with ordinary scheduling: a busy loop on one core, 4 MB written to `folder` and
  /// synced again and again, packets over the loopback network, and on heeld's socket five watchers, ten
  /// `set` a second, and twenty marks a second, which heeld logs and records.
  BenchLoad(const std::string& folder, const std::string& socket);
  ~BenchLoad();
  BenchLoad(const BenchLoad&) = delete;
  BenchLoad& operator=(const BenchLoad&) = delete;

  /// Answers of heeld to `set`, and lines of the watchers: they show that the load was there.
  std::size_t sets() const { return sets_; }
  std::size_t watched() const { return watched_; }

 private:
  void keep_core_busy();
  void write_to_disk(const std::string& file);
  void send_packets();
  void set_and_mark(const std::string& socket);
  void watch(const std::string& socket);

  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> sets_{0}, watched_{0};
  std::vector<std::thread> threads_;
};

}  // namespace heel::cli
