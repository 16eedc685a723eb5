#pragma once
// A verb that runs beside the lines of a script, on a thread and with a connection of its own.

#include <chrono>
#include <future>
#include <thread>

#include "client/cli/command.h"

namespace haptic::cli {

class BackgroundVerb {
 public:
  /// Starts it. `command` has the verb's action, and where the daemon is.
  explicit BackgroundVerb(Command command);
  BackgroundVerb(const BackgroundVerb&) = delete;
  BackgroundVerb& operator=(const BackgroundVerb&) = delete;
  /// Ends it and waits.
  ~BackgroundVerb() = default;

  /// Whether it does its work by now, or has ended without; waits so long for it.
  bool has_begun_within(std::chrono::milliseconds patience) const;

  /// Tells it to end, as a signal would.
  void stop() { thread_.request_stop(); }

  bool has_ended_within(std::chrono::milliseconds patience) const;

  /// Waits for its end. Its exit code; throws what it has thrown. Once.
  ExitCode result() { return result_.get(); }

 private:
  void run(const std::stop_token& stop);

  Command command_;
  std::promise<void> begin_;
  std::future<void> begun_ = begin_.get_future();
  std::promise<ExitCode> end_;
  std::future<ExitCode> result_ = end_.get_future();
  std::jthread thread_;  // last: it ends before the rest goes
};

}  // namespace haptic::cli
