#pragma once
// How late a thread wakes up on this machine, measured as cyclictest does: one that sleeps until absolute
// times of CLOCK_MONOTONIC, with the clock and the rights of the daemon's servo thread, and does nothing
// else.

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>

#include "rt/latency_histogram.h"
#include "rt/realtime_thread.h"

namespace haptic::latency {

/// Upper ends of the bins of a picture, ns: 1, 2, 5 times powers of ten, from 1 us; the last one has no end.
inline constexpr std::array<std::uint64_t, 16> kBinEnds = {
    1'000,   2'000,     5'000,     10'000,    20'000,     50'000,     100'000,    200'000,
    500'000, 1'000'000, 2'000'000, 5'000'000, 10'000'000, 20'000'000, 50'000'000, 100'000'000};

/// Latenesses of wake-ups, ns. Real-time safe.
class Latenesses {
 public:
  void record(std::uint64_t nanoseconds) noexcept;

  const rt::LatencyHistogram& histogram() const noexcept { return histogram_; }
  std::uint64_t min_ns() const noexcept { return histogram_.total() == 0 ? 0 : min_ns_; }
  /// Wake-ups that were later than the end before, and not later than kBinEnds[i]; the last: than all of
  /// these.
  const std::array<std::uint64_t, kBinEnds.size() + 1>& bins() const noexcept { return bins_; }

 private:
  rt::LatencyHistogram histogram_;
  std::uint64_t min_ns_ = UINT64_MAX;
  std::array<std::uint64_t, kBinEnds.size() + 1> bins_{};
};

struct Settings {
  double rate_hz = 1000.0;
  std::chrono::duration<double> duration{60.0};
  rt::RealtimeSettings thread{.lock_memory = true};
  bool awake = false;  // hold cores out of deep sleep meanwhile, as the daemon does while it is armed
};

struct Measured {
  Latenesses times;
  std::uint64_t missed = 0;  // periods that were slept through
  double seconds = 0.0;
  bool is_awake = false;      // cores were held out of deep sleep
  rt::RealtimeReport rights;  // with a warning for all that was refused
};

/// Measures until the time is over or `stop` tells so, which the measuring thread asks after each wake-up.
/// Throws std::system_error if there can be no thread.
Measured measure(const Settings& settings, const std::function<bool()>& stop);

}  // namespace haptic::latency
