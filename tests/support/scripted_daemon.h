#pragma once
// A daemon of few words, for what no real one says: another version's hello, or nonsense.

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <functional>
#include <string>
#include <thread>
#include <utility>

#include "haptic/v1/control.pb.h"
#include "proto/framing.h"
#include "tests/support/temporary_folder.h"

namespace haptic::test {

/// To its one client it sends what it is told to, whatever the client says.
class ScriptedDaemon {
 public:
  explicit ScriptedDaemon(std::string bytes) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    path().copy(name.sun_path, sizeof(name.sun_path) - 1);
    socket_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ::bind(socket_, reinterpret_cast<const sockaddr*>(&name), sizeof(name));
    ::listen(socket_, 1);
    thread_ = std::thread([this, bytes = std::move(bytes)] {
      const int client = ::accept(socket_, nullptr, nullptr);
      ::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      char ignored[1000];
      while (::recv(client, ignored, sizeof(ignored), 0) > 0) {
      }
      ::close(client);
    });
  }
  ScriptedDaemon(const ScriptedDaemon&) = delete;
  ScriptedDaemon& operator=(const ScriptedDaemon&) = delete;
  ~ScriptedDaemon() {
    thread_.join();
    ::close(socket_);
  }

  std::string path() const { return folder_.file("s"); }

 private:
  TemporaryFolder folder_;
  int socket_ = -1;
  std::thread thread_;
};

inline std::string framed(const std::function<void(v1::Envelope&)>& fill) {
  v1::Envelope envelope;
  fill(envelope);
  std::string bytes;
  proto::append_frame(envelope, bytes);
  return bytes;
}

/// The hello of "hapticd 3.0" with protocol `major`.4.
inline std::string hello(std::uint32_t major) {
  return framed([major](v1::Envelope& envelope) {
    envelope.mutable_hello()->set_major(major);
    envelope.mutable_hello()->set_minor(4);
    envelope.mutable_hello()->set_program("hapticd");
    envelope.mutable_hello()->set_version("3.0");
  });
}

}  // namespace haptic::test
