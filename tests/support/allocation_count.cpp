#include "support/allocation_count.h"

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HEEL_SANITIZED_ALLOCATOR 1
#else
#define HEEL_SANITIZED_ALLOCATOR 0
#endif

namespace {
thread_local std::uint64_t allocations = 0;
}

#if !HEEL_SANITIZED_ALLOCATOR
// The C library's own functions, of which its malloc and the like are aliases.
extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* old, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

void* malloc(std::size_t bytes) {
  ++allocations;
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) {
  ++allocations;
  return __libc_calloc(count, bytes);
}
void* realloc(void* old, std::size_t bytes) {
  ++allocations;
  return __libc_realloc(old, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  ++allocations;
  return __libc_memalign(alignment, bytes);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t bytes) {
  ++allocations;
  *out = __libc_memalign(alignment, bytes);
  return *out == nullptr ? ENOMEM : 0;
}
}
#endif

namespace heel::test {

bool counts_allocations() {
  if (HEEL_SANITIZED_ALLOCATOR != 0) return false;
  void* (*volatile allocate)(std::size_t) =
      &std::malloc;  // volatile: the compiler may not leave the call out
  const std::uint64_t before = allocations;
  std::free(allocate(1));
  if (allocations != before + 1) throw std::logic_error("this program's allocations are not counted");
  allocations = before;
  return true;
}

std::uint64_t allocations_of_this_thread() {
  return allocations;
}

}  // namespace heel::test
