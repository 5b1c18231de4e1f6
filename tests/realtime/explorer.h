// Every interleaving of a few threads, and every value that a weakly ordered processor may let a load see.
//
// The code under test takes its atomic variables and its shared records from a memory policy, ExploredMemory
// in place of StdMemory (realtime/memory_policy.h). explore() runs the threads as coroutines on one real
// thread, again and again: before each atomic operation any thread may go on, and a load may give any store
// that the C++ memory model allows. It takes each choice once, depth first.
//
// The model: each atomic variable keeps all of its stores, in the order of their execution. A load may give
// any store that is not older than one that its thread has seen, or that happens before the load (coherence).
// A read-modify-write takes the newest store. An acquiring load of what a releasing store wrote, or of the
// release sequence that it heads, joins the clocks of the two threads. Two accesses to a Record of which one
// writes and neither happens before the other are a data race, and fail the run. Not explored: stores of two
// threads to one variable in another order than that of their execution, and seq_cst (treated as acq_rel).
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace heel::test {

inline constexpr std::size_t kMostThreads = 2;

/// What of each thread's past is known: its number of operations.
using VectorClock = std::array<std::uint32_t, kMostThreads>;

/// One way that a run of the threads can end. Thrown by a check of the test, or by a data race.
struct Violation : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Orders that a test makes weaker, to show that the explorer notices.
enum class Planted : std::uint8_t { Nothing, NoRelease, NoAcquire };

struct Explored {
  std::uint64_t runs = 0;
  std::string violation;  ///< of the first bad run; empty: there is none
};

/// One run: makes new objects, and gives the threads and the check after both have ended.
struct OneRun {
  std::vector<std::function<void()>> threads;
  std::function<void()> at_end = [] {};
};

/// Takes every choice once, up to the first violation.
Explored explore(const std::function<OneRun()>& make_run, Planted planted = Planted::Nothing);

namespace explorer {

/// Of the running exploration; outside of one there is a single thread with number 0.
std::size_t this_thread();
VectorClock& clock();
bool synchronises_as(std::memory_order order, bool acquire);
/// Numbers the variables of a run in the order of their construction.
std::size_t new_variable();
/// Before an operation on a variable: another thread may go on here, unless that changes nothing. It changes
/// nothing where no other thread ever accesses the variable, or, before a load, where none ever writes it.
void switch_point(std::size_t variable, bool writes);
/// One of `count` ways to go on.
std::size_t choose(std::size_t count);
[[noreturn]] void fail(const std::string& what);

inline bool has_happened(const VectorClock& now, std::size_t thread, std::uint32_t time) {
  return now[thread] >= time;
}
inline void join(VectorClock& into, const VectorClock& other) {
  for (std::size_t i = 0; i < into.size(); ++i) into[i] = std::max(into[i], other[i]);
}

}  // namespace explorer

template <typename T>
class ExploredAtomic {
 public:
  ExploredAtomic(T value) : variable_(explorer::new_variable()), stores_{{value, 0, 0, {}}} {}  // NOLINT
  ExploredAtomic(const ExploredAtomic&) = delete;
  ExploredAtomic& operator=(const ExploredAtomic&) = delete;

  T load(std::memory_order order) const {
    begin_operation(false);
    std::size_t oldest = seen_[explorer::this_thread()];
    for (std::size_t i = oldest; i < stores_.size(); ++i)
      if (explorer::has_happened(explorer::clock(), stores_[i].thread, stores_[i].time)) oldest = i;
    return read(stores_.size() - 1 - explorer::choose(stores_.size() - oldest), order);
  }

  void store(T value, std::memory_order order) {
    begin_operation(true);
    append(value, order, {});
  }

  T exchange(T value, std::memory_order order) {
    begin_operation(true);
    const VectorClock sequence = stores_.back().released;
    const T before = read(stores_.size() - 1, order);
    append(value, order, sequence);
    return before;
  }

 private:
  struct Store {
    T value;
    std::size_t thread;
    std::uint32_t time;    ///< of its thread's clock; 0: before all
    VectorClock released;  ///< what who acquires it comes to know
  };

  void begin_operation(bool writes) const {
    explorer::switch_point(variable_, writes);
    ++explorer::clock()[explorer::this_thread()];
  }

  T read(std::size_t index, std::memory_order order) const {
    seen_[explorer::this_thread()] = index;
    if (explorer::synchronises_as(order, true)) explorer::join(explorer::clock(), stores_[index].released);
    return stores_[index].value;
  }

  void append(T value, std::memory_order order, VectorClock released) {
    if (explorer::synchronises_as(order, false)) explorer::join(released, explorer::clock());
    const std::size_t thread = explorer::this_thread();
    stores_.push_back({value, thread, explorer::clock()[thread], released});
    seen_[thread] = stores_.size() - 1;
  }

  std::size_t variable_;
  std::vector<Store> stores_;
  mutable std::array<std::size_t, kMostThreads> seen_{};  ///< by thread: the newest store that it knows
};

/// A value that is not atomic: finds data races.
template <typename T>
class ExploredRecord {
 public:
  ExploredRecord() = default;
  ExploredRecord& operator=(const T& value) {
    for (std::size_t thread = 0; thread < kMostThreads; ++thread)
      if (!known(thread, written_) || !known(thread, read_))
        explorer::fail("data race: a write and an access");
    written_[explorer::this_thread()] = now();
    value_ = value;
    return *this;
  }
  operator T() const {  // NOLINT: stands for the value
    for (std::size_t thread = 0; thread < kMostThreads; ++thread)
      if (!known(thread, written_)) explorer::fail("data race: a read and a write");
    read_[explorer::this_thread()] = now();
    return value_;
  }

 private:
  static std::uint32_t now() { return explorer::clock()[explorer::this_thread()]; }
  static bool known(std::size_t thread, const VectorClock& times) {
    return thread == explorer::this_thread() ||
           explorer::has_happened(explorer::clock(), thread, times[thread]);
  }

  T value_{};
  VectorClock written_{};  ///< by thread: when it wrote last
  mutable VectorClock read_{};
};

struct ExploredMemory {
  template <typename T>
  using Atomic = ExploredAtomic<T>;
  template <typename T>
  using Record = ExploredRecord<T>;
};

}  // namespace heel::test
