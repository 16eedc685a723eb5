#pragma once
// TLS over a connected socket: version 1.3 only. Shows the program's certificate, and believes no server but
// one that has a certificate of the authority for the name that it was called by.

#include <memory>
#include <string>

#include "client/lib/stream_socket.h"

namespace haptic::client {

/// PEM files, as `hapticctl certificates` makes them.
struct Identity {
  std::string certificate;
  std::string key;
  std::string authority;

  bool empty() const noexcept { return certificate.empty() && key.empty() && authority.empty(); }
};

class Tls {
 public:
  /// `server`: a host's name or IP address. Throws Invalid if a file is missing or cannot be used.
  Tls(const Identity& identity, const std::string& server);
  Tls(Tls&&) noexcept;
  Tls& operator=(Tls&&) noexcept;
  ~Tls();

  /// Throws Unreachable, in words, if the two do not trust each other. Whether the server trusts this client
  /// shows when something is received.
  void handshake(StreamSocket& socket, Clock::time_point deadline);

  // As those of StreamSocket.
  StreamSocket::Outcome send(StreamSocket& socket, std::string_view bytes, Clock::time_point deadline);
  StreamSocket::Outcome receive(StreamSocket& socket, std::span<char> buffer, std::size_t& received,
                                Clock::time_point deadline);

  /// Why the connection ended, if TLS knows: "tlsv13 alert certificate required". Else empty.
  const std::string& problem() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptic::client
