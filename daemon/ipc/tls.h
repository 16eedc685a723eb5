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

/// What is wrong with a file that the config names.
struct TlsFileProblem {
  std::string field;    // "certificate", "key" or "authority"
  std::string message;  // with the file's name
};

/// All that is wrong with the files: one that cannot be opened or is no such PEM, a certificate that is not
/// valid today, a key that is not the certificate's. Empty: they can be used.
std::vector<TlsFileProblem> find_problems(const v1::Listen::Tls& config);

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
