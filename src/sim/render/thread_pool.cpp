#include "sim/render/thread_pool.h"

#include <algorithm>

namespace heel::sim {

ThreadPool::ThreadPool(int threads) {
  constexpr int kMaxThreads = 4;  // with more, the parts that are not parallel take most of the time
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int wanted = threads > 0 ? threads : std::min(cores, kMaxThreads);
  for (int i = 1; i < wanted; ++i) helpers_.emplace_back([this] { run_helper(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  job_started_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadPool::parallel_for(int count, int chunk, const std::function<void(int begin, int end)>& work) {
  if (helpers_.empty()) {
    work(0, count);
    return;
  }
  {
    const std::scoped_lock lock(mutex_);
    work_ = &work;
    count_ = count;
    chunk_ = std::max(1, chunk);
    next_ = 0;
    accepts_helpers_ = true;
    ++job_;
  }
  job_started_.notify_all();
  process_chunks();
  std::unique_lock lock(mutex_);
  // A helper that has not joined by now is not waited for: on a loaded machine it might take longer to start
  // than the work took.
  accepts_helpers_ = false;
  helpers_finished_.wait(lock, [this] { return busy_helpers_ == 0; });
}

void ThreadPool::run_helper() {
  std::uint64_t last_job = 0;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      job_started_.wait(lock, [&] { return stop_ || job_ != last_job; });
      if (stop_) return;
      last_job = job_;
      if (!accepts_helpers_) continue;
      ++busy_helpers_;
    }
    process_chunks();
    const std::scoped_lock lock(mutex_);
    if (--busy_helpers_ == 0) helpers_finished_.notify_one();
  }
}

void ThreadPool::process_chunks() {
  while (true) {
    const int begin = next_.fetch_add(chunk_);
    if (begin >= count_) return;
    (*work_)(begin, std::min(begin + chunk_, count_));
  }
}

}  // namespace heel::sim
