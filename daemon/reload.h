#pragma once
// Reading the config again while the daemon runs, as SIGHUP asks for it.

#include "daemon/run.h"
#include "haptic/v1/config.pb.h"
#include "ipc/server.h"

namespace haptic {

/// The server's part of the config, with what the command line says instead.
ipc::ServerSettings settings_of(const RunOptions& options, const v1::DaemonConfig& config);

/// One thread at a time. The server must outlive it.
class Reloader {
 public:
  Reloader(RunOptions options, v1::DaemonConfig running, ipc::Server& server);

  /// Takes over what can be (load/config_difference.h), and logs what needs a restart. A file that is wrong
  /// is logged with the place, and nothing is changed.
  void reload() noexcept;

 private:
  RunOptions options_;
  v1::DaemonConfig running_;
  ipc::Server& server_;
};

}  // namespace haptic
