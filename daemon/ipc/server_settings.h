#pragma once
// What the server takes from the config: where it listens, what one client can take of it, and who drives.

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "ipc/drive_lease.h"
#include "ipc/flight_recorder.h"
#include "ipc/metrics_server.h"
#include "ipc/peer.h"
#include "ipc/session_limits.h"

namespace haptic::ipc {

struct ServerSettings {
  std::vector<v1::Listen> listen;   // empty: a Unix socket at the default place
  std::vector<int> passed_sockets;  // that the service manager opened; each is for the entry of its path
  SessionLimits session;
  DrivePolicy drive;
  FlightSettings flight;
  std::optional<MetricsSettings> metrics;  // none: not told
  std::size_t clients = 64;
  std::size_t clients_per_user = 32;
  std::chrono::milliseconds poll_period{2};        // of mailbox; 64 snapshots must not come in it
  std::chrono::milliseconds servo_patience{2000};  // for the answer to a command

  /// Decides instead of the peer's credentials, in tests.
  RoleOf role_of;
};

/// Every field of `config` that has a default must be set, as load_config() does.
ServerSettings server_settings(const v1::DaemonConfig& config);

}  // namespace haptic::ipc
