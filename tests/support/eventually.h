#pragma once
// Waiting for what other threads bring about.

#include <chrono>
#include <thread>

namespace haptic::test {

/// Whether `is_so()` becomes true within 20 s; it is asked about every millisecond.
template <class Condition>
bool eventually(const Condition& is_so) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < give_up) {
    if (is_so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace haptic::test
