// Waiting for a 32-bit word to change, with a timeout (std::atomic::wait has none), within a process or
// between processes that share the word's memory.
#pragma once

#include <atomic>
#include <cstdint>

#include "heel/time.h"

namespace heel {

enum class FutexScope : std::uint8_t { Process, Shared };

/// Sleeps while `word` is `expected`, at most `timeout_ns`; may return early. The caller looks again itself.
void futex_wait(const std::atomic<std::uint32_t>& word, std::uint32_t expected, TimeNs timeout_ns,
                FutexScope scope);

/// Wakes everyone who waits on `word`. Change the word first.
void futex_wake_all(const std::atomic<std::uint32_t>& word, FutexScope scope);

}  // namespace heel
