#pragma once
// The service manager's end of sd_notify(): a socket that $NOTIFY_SOCKET names for as long as this lives.

#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace haptic::test {

class NotifySocket {
 public:
  NotifySocket() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    const std::string path = folder_.file("notify");
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    path.copy(name.sun_path, sizeof(name.sun_path) - 1);
    if (::bind(socket_, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) {
      throw std::runtime_error("cannot bind " + path);
    }
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  ~NotifySocket() {
    ::unsetenv("NOTIFY_SOCKET");
    ::close(socket_);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// What has been told since the last time, in order.
  std::vector<std::string> take() const {
    std::vector<std::string> told;
    char text[1024];
    for (;;) {
      const ssize_t size = ::recv(socket_, text, sizeof(text), 0);
      if (size < 0) return told;
      told.emplace_back(text, static_cast<std::size_t>(size));
    }
  }

 private:
  TemporaryFolder folder_;
  int socket_;
};

}  // namespace haptic::test
