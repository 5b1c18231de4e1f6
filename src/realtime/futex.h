// Waiting until a 32-bit word changes, with a timeout (std::atomic::wait has none), within one process or
// between processes that share the word's memory.
#pragma once

#include <atomic>
#include <cstdint>

#include "heel/time.h"

namespace heel {

enum class FutexScope : std::uint8_t { Process, Shared };

/// Sleeps while `word` is `expected`, at most `timeout_ns`. May return early: the caller must check the word.
void futex_wait(const std::atomic<std::uint32_t>& word, std::uint32_t expected, TimeNs timeout_ns,
                FutexScope scope);

/// Wakes all threads that wait on `word`. Change the word before the call.
void futex_wake_all(const std::atomic<std::uint32_t>& word, FutexScope scope);

}  // namespace heel
