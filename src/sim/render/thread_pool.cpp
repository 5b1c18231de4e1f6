#include "sim/render/thread_pool.h"

#include <algorithm>

namespace heel::sim {

ThreadPool::ThreadPool(int threads) {
  constexpr int kMost = 4;  // beyond, the parts that are not shared decide
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int wanted = threads > 0 ? threads : std::min(cores, kMost);
  for (int i = 1; i < wanted; ++i) helpers_.emplace_back([this] { help(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  begin_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadPool::parallel_for(int count, int piece, const std::function<void(int begin, int end)>& work) {
  if (helpers_.empty()) {
    work(0, count);
    return;
  }
  {
    const std::scoped_lock lock(mutex_);
    work_ = &work;
    count_ = count;
    piece_ = std::max(1, piece);
    next_ = 0;
    open_ = true;
    ++round_;
  }
  begin_.notify_all();
  take_pieces();
  std::unique_lock lock(mutex_);
  // Who has not come by now is not waited for: on a busy machine that could take longer than the work did.
  open_ = false;
  done_.wait(lock, [this] { return busy_ == 0; });
}

void ThreadPool::help() {
  std::uint64_t seen = 0;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      begin_.wait(lock, [&] { return stop_ || round_ != seen; });
      if (stop_) return;
      seen = round_;
      if (!open_) continue;
      ++busy_;
    }
    take_pieces();
    const std::scoped_lock lock(mutex_);
    if (--busy_ == 0) done_.notify_one();
  }
}

void ThreadPool::take_pieces() {
  while (true) {
    const int begin = next_.fetch_add(piece_);
    if (begin >= count_) return;
    (*work_)(begin, std::min(begin + piece_, count_));
  }
}

}  // namespace heel::sim
