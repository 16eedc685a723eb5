#pragma once
// The daemon's side of the wire, on one thread: accepts clients, answers them, publishes frames and events.
// Between it and the servo thread there is only the mailbox: no client can delay a tick.

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "ipc/authoriser.h"
#include "ipc/listen_socket.h"
#include "ipc/services.h"
#include "ipc/session_limits.h"

namespace haptic::ipc {

struct ServerSettings {
  std::vector<v1::Listen> listen;  // empty: a Unix socket at the default place
  SessionLimits session;
  std::size_t clients = 256;
  std::chrono::milliseconds poll_period{2};        // of mailbox; 64 snapshots must not come in it
  std::chrono::milliseconds servo_patience{2000};  // for the answer to a command

  /// Decides instead of the peer's credentials, in tests.
  std::function<std::optional<v1::Role>(const PeerCredentials&)> role_of;
};

class Server {
 public:
  /// Opens the sockets; clients wait until run(). Throws ListenError. `services.mailbox` must outlive it.
  Server(ServerSettings settings, Services services);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Serves on the calling thread, the io thread, until stop().
  void run();

  /// Says goodbye to all clients and ends run(). Any thread; safe before run().
  void stop();

  /// Where it listens, for a log: paths of Unix sockets, host:port of TCP (with the port that was chosen for
  /// 0).
  const std::vector<std::string>& addresses() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptic::ipc
