// What a running process costs, by thread and by mapping, as the kernel counts it in /proc.
#pragma once

#include <sched.h>
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace heel::evaluation {

/// Counts are since the thread's start.
struct ThreadFigures {
  pid_t id = 0;
  std::string name;
  double cpu_s = 0.0;
  std::uint64_t minor_faults = 0;
  std::uint64_t major_faults = 0;
  std::uint64_t switches = 0;         ///< it waited for something
  std::uint64_t forced_switches = 0;  ///< the kernel gave its core to another thread
  int policy = 0;                     ///< SCHED_OTHER, SCHED_FIFO …, without flags
  int priority = 0;
  cpu_set_t cores{};
};

/// Of each thread, in the order of their numbers; those that end meanwhile are left out. Throws heel::Error
/// when there is no such process.
std::vector<ThreadFigures> threads_of(pid_t process);

struct MappingFigures {
  std::string name;  ///< of the file; "[heap]", "[stack]"; "anonymous"
  double pss_mb = 0.0;
  double resident_mb = 0.0;
};

/// MB are 10⁶ bytes.
struct MemoryFigures {
  double resident_mb = 0.0;
  double peak_mb = 0.0;  ///< largest resident_mb so far
  double locked_mb = 0.0;
  std::vector<MappingFigures> mappings;  ///< largest first
};

/// Throws heel::Error when there is no such process.
MemoryFigures memory_of(pid_t process);

}  // namespace heel::evaluation
