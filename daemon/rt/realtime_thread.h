#pragma once
// The thread that ticks: SCHED_FIFO, bound to a core, memory locked, its stack touched beforehand, as far as
// the system permits. What is refused is told in words, with the reason and the remedy, and stops nothing:
// an ordinary user without rights gets the same daemon with more jitter.

#include <pthread.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptic::rt {

struct RealtimeSettings {
  int priority = 80;              // SCHED_FIFO, 1 to 99
  std::optional<unsigned> cpu{};  // the core that the thread is bound to
  bool lock_memory = false;       // all of the process, now and in future
};

/// What the system granted.
struct RealtimeReport {
  bool fifo = false;
  int priority = 0;  // of SCHED_FIFO; 0 without
  bool memory_locked = false;
  std::optional<unsigned> cpu;
  std::vector<std::string> warnings;  // one sentence for each thing that was asked for and refused
};

class RealtimeThread {
 public:
  /// Runs `body` on a new thread after the rights are settled. Returns then too. Throws std::system_error if
  /// the thread cannot be created, and for nothing else. `body` must not throw.
  RealtimeThread(const RealtimeSettings& settings, std::function<void()> body);

  /// Waits for `body` to return.
  ~RealtimeThread();

  RealtimeThread(const RealtimeThread&) = delete;
  RealtimeThread& operator=(const RealtimeThread&) = delete;

  /// Waits for `body` to return. Owner's thread; more than once does nothing.
  void join() noexcept;

  const RealtimeReport& report() const noexcept;

 private:
  struct Start;
  static void* run(void* argument);

  std::unique_ptr<Start> start_;  // shared with the thread until it has ended
  pthread_t thread_{};
  bool joinable_ = false;
};

}  // namespace haptic::rt
