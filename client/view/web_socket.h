#pragma once
// One WebSocket that has been let in, whether over TLS or not. io thread.

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace haptic::gateway {

using Payload = std::shared_ptr<const std::string>;

/// Bytes if there is a payload, which then follows the head, otherwise text.
struct Outgoing {
  std::string head;
  Payload payload;
};

/// Why a socket is closed, as the protocol counts it.
enum class CloseCode : unsigned {
  kGoingAway = 1001,
  kProtocolError = 1002,
  kUnknownData = 1003,
  kBadPayload = 1007,
  kTryAgainLater = 1013,
};

class WebSocket {
 public:
  using OnMessage = std::function<void(std::string_view message, bool is_binary)>;

  WebSocket() = default;
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;
  virtual ~WebSocket() = default;

  /// Called once when it has ended, whoever ended it; then nothing else is.
  virtual void on_end(std::function<void()> on_end) = 0;
  /// Asks for one message, valid while it is called back. Once at a time.
  virtual void read(OnMessage on_message) = 0;
  /// Once at a time.
  virtual void write(Outgoing message, std::function<void()> on_written) = 0;
  /// Says why, for some seconds at the most, and ends.
  virtual void close(CloseCode code, std::string_view reason) = 0;
};

}  // namespace haptic::gateway
