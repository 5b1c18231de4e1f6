// Counts heap allocations by thread, for tests of code that must not allocate. A program that uses it
// compiles allocation_count.cpp, which replaces the C library's malloc.
#pragma once

#include <cstdint>

namespace heel::test {

/// False under the sanitizers, whose allocator takes that place. Throws std::logic_error where counting
/// should work and does not.
bool counts_allocations();

/// Calls of malloc, calloc, realloc and the aligned ones (and so of operator new) by this thread so far.
std::uint64_t allocations_of_this_thread();

}  // namespace heel::test
