// A few threads that share the rows of one picture among them. Every row is worked out by itself, so that the
// result does not depend on how many there are, nor on which does what.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace heel::sim {

class ThreadPool {
 public:
  /// `threads` in all, the caller among them; 0: one a core, four at most.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(helpers_.size()) + 1; }
  /// Calls work(begin, end) for pieces of [0, count) of at most `piece`, and returns when all are done.
  /// `work` must not throw.
  void parallel_for(int count, int piece, const std::function<void(int begin, int end)>& work);

 private:
  void help();
  void take_pieces();

  std::mutex mutex_;
  std::condition_variable begin_;
  std::condition_variable done_;
  std::uint64_t round_ = 0;  ///< of work; helpers wait for the next
  bool open_ = false;        ///< helpers may still join this round
  int busy_ = 0;             ///< helpers that have joined and are not yet through
  bool stop_ = false;
  // This round's work.
  const std::function<void(int, int)>* work_ = nullptr;
  int count_ = 0;
  int piece_ = 1;
  std::atomic<int> next_{0};
  std::vector<std::thread> helpers_;  ///< last: begin when all else stands
};

}  // namespace heel::sim
