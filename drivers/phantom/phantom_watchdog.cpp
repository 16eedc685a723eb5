#include "drivers/phantom/phantom_watchdog.h"

#include <thread>
#include <utility>

#include "rt/tick_clock.h"

namespace haptic::drivers::phantom {

namespace {

// above the device's own thread, which may be what keeps a core busy
constexpr int kPriority = 86;

}  // namespace

Watchdog::Watchdog(std::chrono::milliseconds patience, std::function<void()> trip)
    : patience_ns_(std::chrono::nanoseconds(patience).count()),
      trip_(std::move(trip)),
      last_beat_ns_(rt::monotonic_ns()),
      thread_(std::make_unique<rt::RealtimeThread>(rt::RealtimeSettings{.priority = kPriority},
                                                   [this] { watch(); })) {}

Watchdog::~Watchdog() {
  ends_.store(true, std::memory_order_release);
  thread_.reset();
}

void Watchdog::beat() noexcept { last_beat_ns_.store(rt::monotonic_ns(), std::memory_order_release); }

void Watchdog::watch() noexcept {
  const std::chrono::nanoseconds pause(patience_ns_ / 4);
  while (!ends_.load(std::memory_order_acquire)) {
    std::this_thread::sleep_for(pause);
    if (rt::monotonic_ns() - last_beat_ns_.load(std::memory_order_acquire) <= patience_ns_) continue;
    if (ends_.load(std::memory_order_acquire)) return;
    tripped_.store(true, std::memory_order_release);
    trip_();
    return;
  }
}

}  // namespace haptic::drivers::phantom
