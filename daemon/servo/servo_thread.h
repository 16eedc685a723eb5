#pragma once
// The thread that ticks in the service.

#include <atomic>
#include <cstdint>

#include "rt/realtime_thread.h"
#include "servo/servo_loop.h"

namespace haptic::servo {

class ServoThread {
 public:
  /// Ticks `loop` at `rate_hz` from now on, on a real-time thread as far as the system permits. The loop must
  /// outlive this. Throws std::system_error if no thread can be made.
  ServoThread(const rt::RealtimeSettings& settings, double rate_hz, ServoLoop& loop);
  ~ServoThread();

  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  /// Disarms, ticks on until no device is given any force (0.1 s at most), then ends the thread. More than
  /// once does nothing. Owner's thread.
  void stop() noexcept;

  /// Ticks that were run. Any thread: one that stands still tells that the servo thread hangs.
  std::uint64_t heartbeat() const noexcept { return heartbeat_.load(std::memory_order_relaxed); }

  /// The rights that the system granted.
  const rt::RealtimeReport& report() const noexcept { return thread_.report(); }

 private:
  void run(double rate_hz, ServoLoop& loop) noexcept;

  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> heartbeat_{0};
  rt::RealtimeThread thread_;
};

}  // namespace haptic::servo
