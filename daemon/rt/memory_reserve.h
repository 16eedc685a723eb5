#pragma once
// What becomes of the daemon when memory runs out. Nothing can be relied on then (protobuf, for one, does not
// survive an exception from the allocator), but hands must be let go of in order. So memory is held back: the
// first allocation that fails gets it, nothing fails, and the owner is told to end the daemon. When that is
// not enough either, the program ends at once, and forces expire in the drivers.

#include <cstddef>

namespace haptic::rt {

/// There is one at a time.
class MemoryReserve {
 public:
  /// `on_spent` is called once at most, on the thread that wanted memory. It must not allocate.
  MemoryReserve(std::size_t bytes, void (*on_spent)() noexcept);
  ~MemoryReserve();

  MemoryReserve(const MemoryReserve&) = delete;
  MemoryReserve& operator=(const MemoryReserve&) = delete;

  /// Memory has run out. Any thread; real-time safe.
  bool is_spent() const noexcept;
};

/// While it lives, want of memory on its thread throws std::bad_alloc and touches no reserve: for work that
/// may fail because it is too large, such as building a scene.
class MemoryMayRunOut {
 public:
  MemoryMayRunOut() noexcept;
  ~MemoryMayRunOut();

  MemoryMayRunOut(const MemoryMayRunOut&) = delete;
  MemoryMayRunOut& operator=(const MemoryMayRunOut&) = delete;
};

}  // namespace haptic::rt
