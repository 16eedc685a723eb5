#pragma once
// The local socket on which another program serves a device. Knows descriptors and users, and no message.

#include <sys/types.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace haptic::drivers::external {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) noexcept : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Descriptor();

  int get() const noexcept { return value_; }
  explicit operator bool() const noexcept { return value_ >= 0; }

 private:
  int value_;
};

/// root, the user who runs the daemon, and the users of these names. Throws DeviceError for a name that is
/// none.
std::vector<uid_t> permitted_users(std::span<const std::string> names);

/// A SEQPACKET socket that listens at a path, and removes it in the end.
class ListenSocket {
 public:
  /// Takes the place of a socket that a dead daemon left. `others`: not only the daemon's user may connect;
  /// who may is for the caller to see (user_of()). Throws DeviceError.
  ListenSocket(const std::string& path, bool others);
  ~ListenSocket();

  ListenSocket(const ListenSocket&) = delete;
  ListenSocket& operator=(const ListenSocket&) = delete;

  int get() const noexcept { return socket_.get(); }

  /// Whoever waits to be connected; none if nobody does.
  Descriptor accept() const noexcept;

 private:
  std::string path_;
  Descriptor socket_;
};

/// The kernel's word about who connected; false if it has none.
bool user_of(const Descriptor& peer, uid_t& user) noexcept;

enum class Reception { kMessage, kNothing, kEnded };

/// The next message, of which at most `buffer` is kept; `size` is its whole size. Never waits.
Reception receive(const Descriptor& peer, std::span<std::byte> buffer, std::size_t& size) noexcept;

/// Never waits: a peer that does not read loses the message.
void send(const Descriptor& peer, std::span<const std::byte> message) noexcept;

}  // namespace haptic::drivers::external
