#pragma once
// Where one device stands in its life, told by its driver, and what it is asked for meanwhile.
//
//     device's thread  --tell(), ready(), lose()-->  state()   servo thread: one atomic load
//                      --tell(), tell_serial()---->  words()   io thread: under a lock that no servo tick
//                      takes
//                      <--take()------------------   request() io thread

#include <atomic>
#include <mutex>
#include <string>

#include "drivers/device.h"

namespace haptic::drivers {

class DeviceLife {
 public:
  // Any thread; real-time safe.

  DeviceState state() const noexcept { return state_.load(std::memory_order_acquire); }

  // io thread.

  /// Empty reason if it is ready, whatever was told before.
  DeviceWords words() const;
  void request(DeviceAction action) noexcept;

  // The device's threads, one at a time.

  /// A phase other than kReady, and why it goes no further.
  void tell(DevicePhase phase, std::string reason);
  /// Empty: it has none, or is closed.
  void tell_serial(std::string serial);
  /// Its samples count from now on. Real-time safe.
  void ready() noexcept;
  /// It is lost: one more time, and `phase` from now on.
  void lose(DevicePhase phase, std::string reason);
  /// Whether that was asked for since the last call. Real-time safe.
  bool take(DeviceAction action) noexcept;
  /// Forgets what was asked for.
  void forget_requests() noexcept { requests_.store(0, std::memory_order_relaxed); }

 private:
  void store(DeviceState state, std::string reason);

  std::atomic<DeviceState> state_{DeviceState{.phase = DevicePhase::kAbsent}};
  static_assert(std::atomic<DeviceState>::is_always_lock_free);
  std::atomic<std::uint32_t> requests_{0};  // bit n: action n
  mutable std::mutex mutex_;                // of what follows
  DeviceWords words_;
};

}  // namespace haptic::drivers
