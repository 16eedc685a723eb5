#pragma once
// How often this program has asked the heap for memory: a tick must not. Link allocation_count.cpp, which
// replaces the global operator new.

#include <cstdint>

namespace haptic::test {

/// Since the program started, on all threads.
std::uint64_t allocation_count() noexcept;

}  // namespace haptic::test
