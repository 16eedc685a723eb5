#pragma once
// A second thread that ends a force whose own thread hangs: if nobody beats for `patience`, it calls `trip`
// once, and the watchdog stays tripped.

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>

#include "rt/realtime_thread.h"

namespace haptic::drivers::phantom {

class Watchdog {
 public:
  /// `trip` runs on the watchdog's thread, and must not throw. The first beat counts from now. Throws
  /// std::system_error if the thread cannot be made.
  Watchdog(std::chrono::milliseconds patience, std::function<void()> trip);
  /// Ends the thread; `trip` is not called any more.
  ~Watchdog();

  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Any thread; real-time safe.
  void beat() noexcept;
  bool has_tripped() const noexcept { return tripped_.load(std::memory_order_acquire); }

 private:
  void watch() noexcept;

  std::int64_t patience_ns_;
  std::function<void()> trip_;
  std::atomic<std::int64_t> last_beat_ns_;
  std::atomic<bool> tripped_{false};
  std::atomic<bool> ends_{false};
  std::unique_ptr<rt::RealtimeThread> thread_;
};

}  // namespace haptic::drivers::phantom
