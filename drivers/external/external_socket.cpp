#include "drivers/external/external_socket.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/device_error.h"

namespace haptic::drivers::external {

namespace {

constexpr int kBacklog = 4;

std::string reason() { return std::strerror(errno); }

sockaddr_un name_of(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.size() >= sizeof(name.sun_path))
    throw DeviceError("the path " + path + " is too long for a socket");
  std::memcpy(name.sun_path, path.data(), path.size());
  return name;
}

Descriptor make_socket() {
  return Descriptor(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

void remove_stale(const std::string& path, const sockaddr_un& name) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return;
  if (!S_ISSOCK(status.st_mode)) {
    throw DeviceError("cannot listen on " + path + ": there is a file of that name which is no socket");
  }
  const Descriptor probe = make_socket();
  if (::connect(probe.get(), reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0 ||
      errno != ECONNREFUSED) {
    throw DeviceError("cannot listen on " + path + ": another program listens there");
  }
  if (::unlink(path.c_str()) != 0) {
    throw DeviceError("cannot remove the socket that a dead daemon left at " + path + ": " + reason());
  }
}

}  // namespace

Descriptor::~Descriptor() {
  if (value_ >= 0) ::close(value_);
}

std::vector<uid_t> permitted_users(std::span<const std::string> names) {
  std::vector<uid_t> users{0, ::geteuid()};
  for (const std::string& name : names) {
    std::vector<char> buffer(std::size_t{16} * 1024);
    passwd entry{};
    passwd* found = nullptr;
    ::getpwnam_r(name.c_str(), &entry, buffer.data(), buffer.size(), &found);
    if (found == nullptr) throw DeviceError("there is no user \"" + name + "\", who is to serve it");
    users.push_back(found->pw_uid);
  }
  return users;
}

ListenSocket::ListenSocket(const std::string& path, bool others) : path_(path) {
  const sockaddr_un name = name_of(path);
  remove_stale(path, name);
  socket_ = make_socket();
  if (!socket_ || ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) {
    throw DeviceError("cannot listen on " + path + ": " + reason());
  }
  // nobody can connect before listen()
  if (::chmod(path.c_str(), others ? 0666 : 0600) != 0 || ::listen(socket_.get(), kBacklog) != 0) {
    const std::string why = reason();
    ::unlink(path.c_str());
    throw DeviceError("cannot listen on " + path + ": " + why);
  }
}

ListenSocket::~ListenSocket() { ::unlink(path_.c_str()); }

Descriptor ListenSocket::accept() const noexcept {
  return Descriptor(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
}

bool user_of(const Descriptor& peer, uid_t& user) noexcept {
  ucred credentials{};
  socklen_t size = sizeof(credentials);
  if (::getsockopt(peer.get(), SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) return false;
  user = credentials.uid;
  return true;
}

Reception receive(const Descriptor& peer, std::span<std::byte> buffer, std::size_t& size) noexcept {
  const ssize_t received = ::recv(peer.get(), buffer.data(), buffer.size(), MSG_DONTWAIT | MSG_TRUNC);
  if (received < 0 && (errno == EAGAIN || errno == EINTR)) return Reception::kNothing;
  // a message of no bytes looks like the end, and no program has a reason to send one
  if (received <= 0) return Reception::kEnded;
  size = static_cast<std::size_t>(received);
  return Reception::kMessage;
}

void send(const Descriptor& peer, std::span<const std::byte> message) noexcept {
  (void)::send(peer.get(), message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace haptic::drivers::external
