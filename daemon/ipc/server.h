#pragma once
// The daemon's side of the wire, on one thread: accepts clients, answers them, publishes frames and events.
// Between it and the servo thread there is only the mailbox: no client can delay a tick.

#include <memory>
#include <string>
#include <vector>

#include "ipc/listen_socket.h"
#include "ipc/server_settings.h"
#include "ipc/services.h"

namespace haptic::ipc {

class Server {
 public:
  /// Opens the sockets; clients wait until run(). Throws ListenError. `services.mailbox` must outlive it.
  Server(ServerSettings settings, Services services);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Serves on the calling thread, the io thread, until stop().
  void run();

  /// Takes over who may come in and do what, certificates, limits and the policy of the drive lease; the
  /// limits of one client hold for those who connect from now on, and a client whose role is another one now
  /// is cut off. Listeners are told by their address; one that the settings do not name keeps what it has,
  /// and none is opened or closed. Throws ListenError in words, and then nothing is changed. Any thread but
  /// the io thread.
  void reload(ServerSettings settings);

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
