#pragma once
// When ticks are due, and the sleep until then. Tick n is due at start + n / rate on CLOCK_MONOTONIC, for
// ever: a late tick does not delay the ones after it (the phase is kept, and a rate that is no whole number
// of nanoseconds does not drift). Periods that were slept through are skipped and counted, never made up: two
// ticks in a row would put twice the force change into one moment of the hand.
//
//     due      |0      |1      |2      |3      |4
//     runs     |0 |1......................|3   |4        tick 1 took too long: tick 2 is missed, 3 is late

#include <cstdint>

namespace haptic::rt {

/// Nanoseconds of CLOCK_MONOTONIC. Any thread; real-time safe.
std::int64_t monotonic_ns() noexcept;

/// The tick that runs now.
struct Wakeup {
  std::uint64_t tick = 0;         // periods since the start; skipped ones count
  std::int64_t due_ns = 0;        // when it was due
  std::uint64_t missed = 0;       // periods skipped just before it
  std::uint64_t lateness_ns = 0;  // from when the first of these was due until now
};

/// The arithmetic of ticks, without a clock. Pure; real-time safe.
class TickSchedule {
 public:
  /// Tick 0 is due at `start_ns`. `rate_hz` > 0.
  TickSchedule(std::int64_t start_ns, double rate_hz) noexcept : start_ns_(start_ns), rate_hz_(rate_hz) {}

  std::int64_t due_ns(std::uint64_t tick) const noexcept;

  /// When the next tick is due.
  std::int64_t next_due_ns() const noexcept { return due_ns(next_); }

  /// The tick that runs at `now_ns`: the latest that is due, or the next if none is.
  Wakeup advance(std::int64_t now_ns) noexcept;

 private:
  std::int64_t start_ns_;
  double rate_hz_;
  std::uint64_t next_ = 0;
};

/// A schedule that sleeps. For the thread that ticks.
class TickClock {
 public:
  /// Tick 0 is due one period from now.
  explicit TickClock(double rate_hz) noexcept;

  /// Sleeps until the next tick is due; at once if it is already. Real-time safe.
  Wakeup wait() noexcept;

 private:
  TickSchedule schedule_;
};

}  // namespace haptic::rt
