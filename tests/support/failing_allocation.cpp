#include "tests/support/failing_allocation.h"

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace haptic::test {
namespace {

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

thread_local bool is_fallible = false;
std::atomic<std::uint64_t> spare{kNever};
std::atomic<std::uint64_t> to_fail{0};
std::atomic<std::uint64_t> failures{0};

bool fails() noexcept {
  if (!is_fallible || spare == kNever) return false;
  if (spare > 0) {
    --spare;
    return false;
  }
  if (to_fail == 0) return false;
  --to_fail;
  ++failures;
  return true;
}

void* allocate(std::size_t size, std::size_t alignment) {
  while (fails()) {
    const std::new_handler make_room = std::get_new_handler();
    if (make_room == nullptr) throw std::bad_alloc();
    make_room();
  }
  // aligned_alloc wants whole multiples of the alignment
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void make_this_thread_fallible() noexcept { is_fallible = true; }

void fail_allocations(std::uint64_t spared, std::uint64_t count) noexcept {
  failures = 0;
  to_fail = count;
  spare = spared;
}

std::uint64_t stop_failing() noexcept {
  spare = kNever;
  to_fail = 0;
  return failures;
}

}  // namespace haptic::test

// the array and nothrow forms call these
void* operator new(std::size_t size) {
  return haptic::test::allocate(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return haptic::test::allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
