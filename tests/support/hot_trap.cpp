// Loaded before a program (LD_PRELOAD), it ends the program at the first call in a hot section
// (realtime/hot_section.h) that allocates, frees, locks or formats text: one line with the thread and the
// function, a backtrace, abort().
//
//   LD_PRELOAD=libheel_hot_trap.so heeld --config heel.toml
//   HEEL_TRAP_PLANT=heel-vision      that thread allocates in its first hot section, to show that the trap
//   works
//
#include <dlfcn.h>
#include <execinfo.h>
#include <fmt/core.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void __libc_free(void* memory);
}

#define HEEL_FMT_FORMAT                                                                           \
  "_ZN3fmt2v96detail10vformat_toIcEEvRNS1_6bufferIT_EENS0_17basic_string_viewIS4_EENS0_17basic_"  \
  "format_argsINS0_20basic_format_contextINSt11conditionalIXsrSt7is_sameINS0_13type_identityIS4_" \
  "E4typeEcE5valueENS0_8appenderESt20back_insert_iteratorINS3_ISF_EEEE4typeESF_EEEENS1_10locale_refE"

namespace {

using FormatArguments = fmt::basic_format_args<fmt::format_context>;
using FormatTo = void(fmt::detail::buffer<char>& out, fmt::string_view format, FormatArguments arguments,
                      fmt::detail::locale_ref locale);

thread_local int sections __attribute__((tls_model("initial-exec"))) = 0;

void print(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) std::abort();
}

/// By prctl: pthread_getname_np reads a file.
std::array<char, 16> thread_name() {
  std::array<char, 16> name{};
  prctl(PR_GET_NAME, name.data());
  return name;
}

void forbid(const char* function) {
  if (sections == 0) return;
  sections = 0;
  print("hot trap: ");
  print(thread_name().data());
  print(" calls ");
  print(function);
  print("\n");
  std::array<void*, 64> frames{};
  backtrace_symbols_fd(frames.data(), backtrace(frames.data(), frames.size()), STDERR_FILENO);
  std::abort();
}

/// The function that this file takes the place of.
template <typename Function>
Function* next(Function*, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// The first backtrace of a program loads a library.
[[gnu::constructor]] void prepare() {
  std::array<void*, 4> frames{};
  backtrace(frames.data(), frames.size());
}

}  // namespace

/// What fmt does all its formatting by, under its name in fmt's library.
FormatTo format_to asm(HEEL_FMT_FORMAT);
void format_to(fmt::detail::buffer<char>& out, fmt::string_view format, FormatArguments arguments,
               fmt::detail::locale_ref locale) {
  forbid("fmt::vformat_to");
  static auto* const real = next(&format_to, HEEL_FMT_FORMAT);
  real(out, format, arguments, locale);
}

extern "C" {

void heel_observe_hot_section(int enters) {
  sections += enters != 0 ? 1 : -1;
  const char* const planted = std::getenv("HEEL_TRAP_PLANT");
  if (enters == 0 || planted == nullptr || std::strcmp(planted, thread_name().data()) != 0) return;
  void* (*volatile allocate)(std::size_t) = &malloc;  // volatile: the compiler may not leave the call out
  std::free(allocate(1));
}

void* malloc(std::size_t bytes) {
  forbid("malloc");
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) {
  forbid("calloc");
  return __libc_calloc(count, bytes);
}
void* realloc(void* memory, std::size_t bytes) {
  forbid("realloc");
  return __libc_realloc(memory, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  forbid("aligned_alloc");
  return __libc_memalign(alignment, bytes);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
  forbid("posix_memalign");
  *memory = __libc_memalign(alignment, bytes);
  return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
  if (memory != nullptr) forbid("free");
  __libc_free(memory);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  forbid("pthread_mutex_lock");
  static auto* const lock = next(&pthread_mutex_lock, "pthread_mutex_lock");
  return lock(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* mutex) {
  forbid("pthread_rwlock_rdlock");
  static auto* const lock = next(&pthread_rwlock_rdlock, "pthread_rwlock_rdlock");
  return lock(mutex);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* mutex) {
  forbid("pthread_rwlock_wrlock");
  static auto* const lock = next(&pthread_rwlock_wrlock, "pthread_rwlock_wrlock");
  return lock(mutex);
}

int vsnprintf(char* text, std::size_t size, const char* format, va_list arguments) {
  forbid("vsnprintf");
  static auto* const print_to = next(&vsnprintf, "vsnprintf");
  return print_to(text, size, format, arguments);
}
int snprintf(char* text, std::size_t size, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int length = vsnprintf(text, size, format, arguments);
  va_end(arguments);
  return length;
}
int vfprintf(std::FILE* file, const char* format, va_list arguments) {
  forbid("vfprintf");
  static auto* const print_to = next(&vfprintf, "vfprintf");
  return print_to(file, format, arguments);
}

}  // extern "C"
