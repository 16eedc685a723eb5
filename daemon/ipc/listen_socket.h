#pragma once
// The sockets that the daemon listens on. Made before anything serves; plain POSIX.

#include <stdexcept>
#include <string>

#include "haptic/v1/config.pb.h"
#include "ipc/authoriser.h"

namespace haptic::ipc {

/// A socket that cannot be listened on; what() says which, why and what to do.
class ListenError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A descriptor that is closed in the end.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) noexcept : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor();

  int get() const noexcept { return value_; }
  int release() noexcept;

 private:
  int value_;
};

/// Where the daemon listens if the config names nothing: HAPTICD_SOCKET, else in systemd's RUNTIME_DIRECTORY,
/// else the user's own place, which is made if need be. Throws ListenError if that place is not private.
std::string default_socket_path();

/// The path of a Unix stream socket that listens. Throws ListenError in words if it is none, or has no path.
std::string path_of_passed(int socket);

/// A Unix stream socket that listens, and the lock that keeps a second daemon from the same path. What a dead
/// daemon left behind is removed; a living one is not disturbed. The file has mode 0660, and its access list
/// admits each group that the config allows. The file is removed in the end, the lock's stays.
class UnixListener {
 public:
  explicit UnixListener(const v1::Listen::Unix& config);
  /// Takes a socket that the service manager opened at that path. The file is the manager's: it stays in the
  /// end, and has its mode; groups are admitted as above.
  UnixListener(const v1::Listen::Unix& config, Descriptor passed);
  UnixListener(const UnixListener&) = delete;
  UnixListener& operator=(const UnixListener&) = delete;
  ~UnixListener();

  const std::string& path() const noexcept { return path_; }
  /// The listening socket; the caller owns it from now on.
  int release() noexcept { return socket_.release(); }
  /// The same way in for other groups.
  void admit(const Authoriser& authoriser) const;

 private:
  void take_lock();
  void remove_stale();
  void bind();
  std::string path_;
  bool is_own_;  // not passed
  Descriptor lock_;
  Descriptor socket_;
};

/// A TCP socket that listens; the caller owns it. Throws ListenError; without TLS an address that is not
/// loopback is refused.
int listen_tcp(const v1::Listen::Tcp& config);

}  // namespace haptic::ipc
