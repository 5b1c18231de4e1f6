// A few threads that process the rows of one picture in parallel. Every row is computed by itself, so that
// the result does not depend on the number of threads or on which thread computes which row.
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
  /// `threads`: their number, the calling thread included; 0: one for each core, but at most four.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(helpers_.size()) + 1; }
  /// Calls work(begin, end) for chunks of [0, count) of at most `chunk`, in several threads, and returns when
  /// all are done. `work` must not throw.
  void parallel_for(int count, int chunk, const std::function<void(int begin, int end)>& work);

 private:
  void run_helper();
  void process_chunks();

  std::mutex mutex_;
  std::condition_variable job_started_;
  std::condition_variable helpers_finished_;
  std::uint64_t job_ = 0;         ///< number of the current or last job
  bool accepts_helpers_ = false;  ///< helpers may still join the current job
  int busy_helpers_ = 0;          ///< helpers that have joined the current job and are not finished
  bool stop_ = false;
  // The current job.
  const std::function<void(int, int)>* work_ = nullptr;
  int count_ = 0;
  int chunk_ = 1;
  std::atomic<int> next_{0};
  std::vector<std::thread> helpers_;  ///< last: they start when every other member is ready
};

}  // namespace heel::sim
