#pragma once
// A `hapticd run` of our own, on a socket in a folder of its own.

#include <sys/types.h>

#include <string>

#include "haptic/v1/control.pb.h"
#include "tests/support/temporary_folder.h"

namespace haptic::bench {

/// User and system time of all threads of a process since it started, s.
double cpu_seconds_of(pid_t process);

class LoadDaemon {
 public:
  /// Starts it with the config, but with room for hundreds of clients, and waits until it answers. Throws
  /// std::runtime_error.
  LoadDaemon(const std::string& program, const std::string& config);
  LoadDaemon(const LoadDaemon&) = delete;
  LoadDaemon& operator=(const LoadDaemon&) = delete;
  ~LoadDaemon();

  const std::string& socket() const noexcept { return socket_; }
  /// `reset`: its counters start again.
  v1::Stats stats(bool reset) const;
  /// Since it started, whatever was reset.
  std::uint64_t missed_ticks() const;
  double cpu_seconds() const { return cpu_seconds_of(process_); }

 private:
  v1::Response call(const v1::Request& request) const;

  test::TemporaryFolder folder_;
  std::string socket_;
  pid_t process_ = -1;
};

}  // namespace haptic::bench
