#pragma once
// A `hapticd run` of our own, on a socket in a folder of its own.

#include <sys/types.h>

#include <string>

#include "haptic/v1/control.pb.h"
#include "tests/support/temporary_folder.h"

namespace haptic::bench {

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
  /// Of all its threads since it started.
  double cpu_seconds() const;

 private:
  test::TemporaryFolder folder_;
  std::string socket_;
  pid_t process_ = -1;
};

}  // namespace haptic::bench
