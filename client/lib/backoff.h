#pragma once
// How long to wait before the next attempt: twice as long each time, up to a bound.

#include <algorithm>
#include <chrono>

namespace haptic::client {

inline constexpr std::chrono::milliseconds kFirstWait{100};
inline constexpr std::chrono::milliseconds kLongestWait{5'000};

class Backoff {
 public:
  std::chrono::milliseconds next() noexcept {
    const std::chrono::milliseconds now = wait_;
    wait_ = std::min(2 * wait_, kLongestWait);
    return now;
  }
  void reset() noexcept { wait_ = kFirstWait; }

 private:
  std::chrono::milliseconds wait_ = kFirstWait;
};

}  // namespace haptic::client
