#pragma once
// How many requests one client may make: a bucket that fills at the rate and holds one second of it. A client
// that goes on for another second's worth of refusals is flooding. Pure; io thread.

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace haptic::ipc {

class RequestRate {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum class Verdict { kTaken, kTooMany, kFlood };

  RequestRate(std::uint32_t per_second, Time now) noexcept
      : per_second_(per_second), tokens_(per_second), filled_(now) {}

  Verdict take(Time now) noexcept {
    const double passed = std::chrono::duration<double>(now - filled_).count();
    tokens_ = std::min(per_second_, tokens_ + per_second_ * passed);
    filled_ = now;
    if (tokens_ >= 1.0) {
      tokens_ -= 1.0;
      // one that has stopped for a while is forgiven
      refused_ = tokens_ >= per_second_ / 2.0 ? 0.0 : refused_;
      return Verdict::kTaken;
    }
    refused_ += 1.0;
    return refused_ > per_second_ ? Verdict::kFlood : Verdict::kTooMany;
  }

 private:
  double per_second_;
  double tokens_;
  double refused_ = 0.0;
  Time filled_;
};

}  // namespace haptic::ipc
