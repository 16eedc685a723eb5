#pragma once
// For tests: while an AllocationGuard lives, what the servo thread must never do ends the program at once,
// with a message that names it: allocating or freeing memory, locking a mutex, throwing, and file or socket
// I/O through read(), write() or open(). Only the thread that made the guard is watched.
//
// The functions of libc are interposed by those of this file, so a test program must link the object library
// haptic_allocation_guard. System calls that libc makes inside, or that are made without it, are not seen.
// Sanitizers interpose the same functions: built with one, the guard watches nothing (kAllocationGuardWorks
// is false).

namespace haptic::rt {

/// False in a build with a sanitizer.
extern const bool kAllocationGuardWorks;

class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  ~AllocationGuard();

  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;
};

}  // namespace haptic::rt
