#include "client/lib/stream_socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "client/lib/error.h"

namespace haptic::client {
namespace {

using Outcome = StreamSocket::Outcome;

constexpr std::chrono::milliseconds kFullPause{5};

// waits until the socket can be read or written, or is broken
Outcome wait_for(int descriptor, short events, Clock::time_point deadline) noexcept {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
  // one more, so that a wait of less than a millisecond is not a busy one
  const int timeout = static_cast<int>(std::clamp<long long>(left + 1, 0, 1'000'000'000));
  pollfd entry{descriptor, events, 0};
  const int ready = ::poll(&entry, 1, timeout);
  if (ready > 0) {
    return Outcome::kDone;
  }
  return ready == 0 ? Outcome::kTimedOut : Outcome::kInterrupted;
}

int finish_connect(int descriptor, Clock::time_point deadline) {
  Outcome outcome = Outcome::kInterrupted;
  while (outcome == Outcome::kInterrupted) {
    outcome = wait_for(descriptor, POLLOUT, deadline);
  }
  if (outcome == Outcome::kTimedOut) {
    return ETIMEDOUT;
  }
  int error = 0;
  socklen_t length = sizeof(error);
  ::getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &length);
  return error;
}

// errno of the attempt, 0 if it succeeded
int try_connect(int descriptor, const sockaddr* address, socklen_t size, Clock::time_point deadline) {
  while (::connect(descriptor, address, size) != 0) {
    if (errno == EAGAIN && Clock::now() < deadline) {
      std::this_thread::sleep_for(kFullPause);  // too many wait to be accepted by a Unix socket
      continue;
    }
    if (errno != EINPROGRESS) {
      return errno;
    }
    return finish_connect(descriptor, deadline);
  }
  return 0;
}

std::string advice(int error) {
  switch (error) {
    case ENOENT:
      return "there is no socket; is hapticd running?";
    case ECONNREFUSED:
      return "nobody listens there; is hapticd running?";
    case EACCES:
      return "permission denied; are you in a group that hapticd's config allows?";
    default:
      return std::strerror(error);
  }
}

[[noreturn]] void throw_unreachable(const Address& address, const std::string& reason) {
  throw Unreachable("cannot reach the daemon at " + to_string(address) + ": " + reason);
}

StreamSocket connect_unix(const Address& address, Clock::time_point deadline) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (address.path.size() >= sizeof(name.sun_path)) {
    throw_unreachable(address, "the path is longer than " + std::to_string(sizeof(name.sun_path) - 1) +
                                   " bytes, which is all that a socket's path can have");
  }
  address.path.copy(name.sun_path, address.path.size());
  StreamSocket socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int error =
      try_connect(socket.descriptor(), reinterpret_cast<const sockaddr*>(&name), sizeof(name), deadline);
  if (error != 0) {
    throw_unreachable(address, advice(error));
  }
  return socket;
}

StreamSocket connect_tcp(const Address& address, Clock::time_point deadline) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int failure = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
  if (failure != 0) {
    throw_unreachable(address, ::gai_strerror(failure));
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  int error = EADDRNOTAVAIL;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
    StreamSocket socket(::socket(entry->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    error = try_connect(socket.descriptor(), entry->ai_addr, entry->ai_addrlen, deadline);
    if (error == 0) {
      const int on = 1;
      ::setsockopt(socket.descriptor(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
      return socket;
    }
  }
  throw_unreachable(address, advice(error));
}

}  // namespace

StreamSocket StreamSocket::connect(const Address& address, Clock::time_point deadline) {
  return address.path.empty() ? connect_tcp(address, deadline) : connect_unix(address, deadline);
}

StreamSocket::StreamSocket(StreamSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

StreamSocket& StreamSocket::operator=(StreamSocket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

StreamSocket::~StreamSocket() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

Outcome StreamSocket::send(std::string_view bytes, Clock::time_point deadline) noexcept {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN) {
      if (wait_for(descriptor_, POLLOUT, deadline) == Outcome::kTimedOut) {
        return Outcome::kTimedOut;
      }
    } else if (errno != EINTR) {
      return Outcome::kClosed;
    }
  }
  return Outcome::kDone;
}

Outcome StreamSocket::receive(std::span<char> buffer, std::size_t& received,
                              Clock::time_point deadline) noexcept {
  while (true) {
    const ssize_t got = ::recv(descriptor_, buffer.data(), buffer.size(), 0);
    if (got > 0) {
      received = static_cast<std::size_t>(got);
      return Outcome::kDone;
    }
    if (got == 0 || (errno != EAGAIN && errno != EINTR)) {
      return Outcome::kClosed;
    }
    const Outcome waited = wait_for(descriptor_, POLLIN, deadline);
    if (waited != Outcome::kDone) {
      return waited;
    }
  }
}

}  // namespace haptic::client
