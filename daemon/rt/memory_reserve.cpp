#include "rt/memory_reserve.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace haptic::rt {
namespace {

std::atomic<void*> held{nullptr};
void (*tell)() noexcept = nullptr;
thread_local int tolerated = 0;

// operator new tries again after it
void give_reserve() {
  if (tolerated > 0) throw std::bad_alloc();
  void* const memory = held.exchange(nullptr);
  if (memory == nullptr) std::abort();
  std::free(memory);
  tell();
}

}  // namespace

MemoryReserve::MemoryReserve(std::size_t bytes, void (*on_spent)() noexcept) {
  tell = on_spent;
  held = std::malloc(bytes);
  if (held == nullptr) throw std::bad_alloc();
  std::set_new_handler(&give_reserve);
}

MemoryReserve::~MemoryReserve() {
  std::set_new_handler(nullptr);
  std::free(held.exchange(nullptr));
}

bool MemoryReserve::is_spent() const noexcept { return held == nullptr; }

MemoryMayRunOut::MemoryMayRunOut() noexcept { ++tolerated; }
MemoryMayRunOut::~MemoryMayRunOut() { --tolerated; }

}  // namespace haptic::rt
