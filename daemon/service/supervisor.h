#pragma once
// Tells the service manager when the daemon is ready, that it lives, and when it reads its config again, by
// what the heartbeat of the servo thread says (heartbeat_watch.h).

#include <atomic>
#include <functional>
#include <string>

#include "service/heartbeat_watch.h"

namespace haptic::service {

class Supervisor {
 public:
  /// `status`: for a person, what the daemon does when it is ready.
  Supervisor(double rate_hz, std::string status);

  const std::string& status() const noexcept { return status_; }

  /// To be called every few milliseconds, with CLOCK_MONOTONIC and the ticks run so far. io thread.
  void look(std::int64_t now_ns, std::uint64_t heartbeat);

  /// Calls `read_again` as a reload; before the daemon is ready it is still a part of the start. Any one
  /// thread.
  void reload(const std::function<void()>& read_again);

 private:
  std::string status_;
  HeartbeatWatch watch_;
  std::atomic<bool> ready_{false};
};

}  // namespace haptic::service
