#pragma once
// Judges the servo thread by its heartbeat, the number of ticks that it has run: whether it keeps its period,
// so that the daemon may call itself ready, and later whether it still lives. The io thread asks; if either
// thread hangs, nobody says that the daemon is alive, and the service manager kills it. Pure: times come from
// the caller, in ns of one clock.
//
//     proving -- a window with nearly all its ticks --> ready, then alive whenever the heartbeat has advanced

#include <cstdint>
#include <optional>

namespace haptic::service {

class HeartbeatWatch {
 public:
  enum class Verdict {
    kNothing,
    kReady,  // once: the servo thread keeps its period
    kAlive,  // from then on: to be told to the watchdog
  };

  /// `watchdog_ns`: the longest silence that the watchdog takes; nothing: nobody watches.
  HeartbeatWatch(double rate_hz, std::optional<std::int64_t> watchdog_ns) noexcept;

  /// What follows from so many ticks until now. To be called every few milliseconds.
  Verdict look(std::int64_t now_ns, std::uint64_t heartbeat) noexcept;

  /// Ticks in a second in the last window of the proof; 0 before the first one ended.
  double measured_hz() const noexcept { return measured_hz_; }

 private:
  Verdict prove(std::int64_t now_ns, std::uint64_t heartbeat) noexcept;

  double rate_hz_;
  std::optional<std::int64_t> watchdog_ns_;
  bool proved_ = false;
  bool begun_ = false;
  std::int64_t since_ns_ = 0;  // of the window, or of the last word to the watchdog
  std::uint64_t since_heartbeat_ = 0;
  double measured_hz_ = 0.0;
};

}  // namespace haptic::service
