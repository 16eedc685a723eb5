#include "rt/allocation_guard.h"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <typeinfo>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define HAPTIC_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAPTIC_SANITIZED 1
#endif

namespace {

// initial-exec, so that reading it never allocates
thread_local int guards __attribute__((tls_model("initial-exec"))) = 0;

}  // namespace

namespace haptic::rt {

#ifdef HAPTIC_SANITIZED
const bool kAllocationGuardWorks = false;
#else
const bool kAllocationGuardWorks = true;
#endif

AllocationGuard::AllocationGuard() noexcept { ++guards; }
AllocationGuard::~AllocationGuard() { --guards; }

}  // namespace haptic::rt

#ifndef HAPTIC_SANITIZED

namespace {

void check(const char* name) noexcept {
  if (guards == 0) return;
  guards = 0;
  constexpr char kText[] = "AllocationGuard: not allowed on the servo path: ";
  syscall(SYS_write, STDERR_FILENO, kText, sizeof kText - 1);
  syscall(SYS_write, STDERR_FILENO, name, std::strlen(name));
  syscall(SYS_write, STDERR_FILENO, "\n", 1);
  std::abort();
}

/// The function that this file hides.
template <class Function>
class Hidden {
 public:
  explicit constexpr Hidden(const char* name) : name_(name) {}
  Function* get() noexcept {
    void* found = found_.load(std::memory_order_relaxed);
    if (found == nullptr) {
      found = dlsym(RTLD_NEXT, name_);
      if (found == nullptr) std::abort();
      found_.store(found, std::memory_order_relaxed);
    }
    return reinterpret_cast<Function*>(found);
  }

 private:
  const char* name_;
  std::atomic<void*> found_{nullptr};
};

constinit Hidden<int(pthread_mutex_t*)> hidden_mutex_lock("pthread_mutex_lock");
constinit Hidden<ssize_t(int, void*, std::size_t)> hidden_read("read");
constinit Hidden<ssize_t(int, const void*, std::size_t)> hidden_write("write");
constinit Hidden<int(const char*, int, ...)> hidden_open("open");
constinit Hidden<void(void*, std::type_info*, void (*)(void*))> hidden_throw("__cxa_throw");

}  // namespace

// glibc has the allocator a second time under these names, which needs no dlsym (that itself allocates)
extern "C" {
void* libc_malloc(std::size_t size) asm("__libc_malloc");
void* libc_calloc(std::size_t count, std::size_t size) asm("__libc_calloc");
void* libc_realloc(void* memory, std::size_t size) asm("__libc_realloc");
void* libc_memalign(std::size_t alignment, std::size_t size) asm("__libc_memalign");
void libc_free(void* memory) asm("__libc_free");
[[noreturn]] void guarded_throw(void* thrown, std::type_info* type,
                                void (*destroy)(void*)) asm("__cxa_throw");

void* malloc(std::size_t size) {
  check("malloc");
  return libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  check("calloc");
  return libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) {
  check("realloc");
  return libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  check("memalign");
  return libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  check("aligned_alloc");
  return libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  check("posix_memalign");
  *memory = libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}

void free(void* memory) {
  if (memory != nullptr) check("free");
  libc_free(memory);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  check("pthread_mutex_lock");
  return hidden_mutex_lock.get()(mutex);
}

ssize_t read(int file, void* bytes, std::size_t count) {
  check("read");
  return hidden_read.get()(file, bytes, count);
}

ssize_t write(int file, const void* bytes, std::size_t count) {
  check("write");
  return hidden_write.get()(file, bytes, count);
}

int open(const char* path, int flags, ...) {
  check("open");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = va_arg(arguments, mode_t);
  va_end(arguments);
  return hidden_open.get()(path, flags, mode);
}

void guarded_throw(void* thrown, std::type_info* type, void (*destroy)(void*)) {
  check("throw");
  hidden_throw.get()(thrown, type, destroy);
  std::abort();
}
}

#endif
