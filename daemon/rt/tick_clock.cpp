#include "rt/tick_clock.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

namespace haptic::rt {

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

}  // namespace

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kNanosecondsPerSecond + now.tv_nsec;
}

std::int64_t TickSchedule::due_ns(std::uint64_t tick) const noexcept {
  // from the tick number and not from the tick before, so that rounding never adds up: a double holds whole
  // nanoseconds exactly for 104 days, and is within 1 ns for years beyond
  return start_ns_ + static_cast<std::int64_t>(std::llround(static_cast<double>(tick) * 1e9 / rate_hz_));
}

Wakeup TickSchedule::advance(std::int64_t now_ns) noexcept {
  const std::int64_t first_due = due_ns(next_);
  Wakeup wakeup{.tick = next_, .due_ns = first_due};
  if (now_ns > first_due) {
    wakeup.lateness_ns = static_cast<std::uint64_t>(now_ns - first_due);
    wakeup.missed = static_cast<std::uint64_t>(static_cast<double>(wakeup.lateness_ns) * rate_hz_ / 1e9);
    // the product is rounded and may be one off
    while (wakeup.missed > 0 && due_ns(next_ + wakeup.missed) > now_ns) --wakeup.missed;
    if (due_ns(next_ + wakeup.missed + 1) <= now_ns) ++wakeup.missed;
    wakeup.tick = next_ + wakeup.missed;
    wakeup.due_ns = due_ns(wakeup.tick);
  }
  next_ = wakeup.tick + 1;
  return wakeup;
}

TickClock::TickClock(double rate_hz) noexcept
    : schedule_(monotonic_ns() + static_cast<std::int64_t>(std::llround(1e9 / rate_hz)), rate_hz) {}

Wakeup TickClock::wait() noexcept {
  const std::int64_t due = schedule_.next_due_ns();
  const timespec until{.tv_sec = due / kNanosecondsPerSecond, .tv_nsec = due % kNanosecondsPerSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  // an absolute sleep never ends early, but were it refused, the tick would still not run before its time
  return schedule_.advance(std::max(monotonic_ns(), due));
}

}  // namespace haptic::rt
