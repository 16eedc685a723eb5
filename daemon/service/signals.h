#pragma once
// The signals that a person or the service manager sends: SIGINT and SIGTERM end the daemon, SIGHUP has it
// read its config again.

#include <csignal>
#include <functional>
#include <thread>

namespace haptic::service {

/// Blocks the three. Made before any thread, so that all inherit the mask and none is interrupted.
class Signals {
 public:
  Signals() noexcept;

  /// The next of them; one that came before is kept until then.
  int wait() const noexcept;

 private:
  sigset_t set_{};
};

/// Waits on a thread of its own. Calls `reload` at each SIGHUP, and `stop` once: at the first signal that
/// ends the daemon, or in the end. Neither may throw.
class SignalThread {
 public:
  SignalThread(const Signals& signals, std::function<void()> reload, std::function<void()> stop);
  ~SignalThread();
  SignalThread(const SignalThread&) = delete;
  SignalThread& operator=(const SignalThread&) = delete;

 private:
  std::thread thread_;
};

}  // namespace haptic::service
