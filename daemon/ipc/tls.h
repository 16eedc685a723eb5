#pragma once
// TLS for clients that come over TCP: version 1.3 only, and both sides show a certificate. What the client's
// is called decides about its role (peer.h). io thread.

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "haptic/v1/config.pb.h"
#include "ipc/stream.h"

namespace haptic::ipc {

/// A client whose certificate is valid.
struct EncryptedPeer {
  std::shared_ptr<Stream> stream;
  std::vector<std::string> names;  // common names of the certificate's subject, and its DNS names
};

class TlsContext {
 public:
  /// Called once: with the peer, or with none and why.
  using OnPeer = std::function<void(EncryptedPeer peer, const std::string& error)>;

  /// Reads the files. Throws ListenError, in words; a key that others can read is only warned of.
  explicit TlsContext(const v1::Listen::Tls& config);
  ~TlsContext();
  TlsContext(const TlsContext&) = delete;
  TlsContext& operator=(const TlsContext&) = delete;

  /// Agrees on keys with whoever is at the socket, who has so long for it.
  void handshake(Stream::Socket socket, std::chrono::milliseconds limit, OnPeer on_peer);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptic::ipc
