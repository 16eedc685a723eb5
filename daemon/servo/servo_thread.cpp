#include "servo/servo_thread.h"

#include "rt/tick_clock.h"

namespace haptic::servo {

namespace {

constexpr double kLongestStop = 0.1;  // s; at the default limits forces are gone after 0.01 s

}  // namespace

ServoThread::ServoThread(const rt::RealtimeSettings& settings, double rate_hz, ServoLoop& loop)
    : thread_(settings, [this, rate_hz, &loop] { run(rate_hz, loop); }) {}

ServoThread::~ServoThread() { stop(); }

void ServoThread::stop() noexcept {
  stopping_.store(true, std::memory_order_relaxed);
  thread_.join();
}

void ServoThread::run(double rate_hz, ServoLoop& loop) noexcept {
  rt::TickClock clock(rate_hz);
  auto last_ticks = static_cast<std::uint64_t>(kLongestStop * rate_hz) + 1;
  for (;;) {
    const rt::Wakeup wakeup = clock.wait();
    const bool stopping = stopping_.load(std::memory_order_relaxed);
    if (stopping) loop.disarm();
    loop.tick({.tick = wakeup.tick,
               .time = wakeup.due_ns,
               .missed = wakeup.missed,
               .lateness_ns = wakeup.lateness_ns});
    heartbeat_.fetch_add(1, std::memory_order_relaxed);
    if (stopping && (loop.is_at_rest() || --last_ticks == 0)) return;
  }
}

}  // namespace haptic::servo
