#pragma once
// A heap that runs out of memory when a test says so. Link failing_allocation.cpp, which replaces the global
// operator new.

#include <cstdint>

namespace haptic::test {

/// From now on allocations of this thread can be made to fail; those of other threads never do.
void make_this_thread_fallible() noexcept;

/// Of the allocations of fallible threads from now on, `count` fail after `spared` that do not.
void fail_allocations(std::uint64_t spared, std::uint64_t count) noexcept;

/// No more. Returns how many have failed since fail_allocations().
std::uint64_t stop_failing() noexcept;

}  // namespace haptic::test
