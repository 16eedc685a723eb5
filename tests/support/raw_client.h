#pragma once
// A peer that says whatever a test wants said, and shows what comes back as it is.

#include <optional>
#include <string>
#include <vector>

#include "client/lib/stream_socket.h"
#include "haptic/v1/control.pb.h"
#include "proto/framing.h"
#include "proto/protocol.h"

namespace haptic::test {

class RawClient {
 public:
  explicit RawClient(const std::string& address)
      : socket_(client::StreamSocket::connect(client::parse_address(address),
                                              client::Clock::now() + std::chrono::seconds(5))) {}

  void send(std::string_view bytes) { socket_.send(bytes, client::Clock::now() + std::chrono::seconds(5)); }

  void send(const v1::Envelope& envelope) {
    std::string bytes;
    proto::append_frame(envelope, bytes);
    send(bytes);
  }

  void say_hello(std::uint32_t major = proto::kProtocolMajor) {
    v1::Envelope envelope;
    envelope.mutable_hello()->set_major(major);
    envelope.mutable_hello()->set_minor(7);
    envelope.mutable_hello()->set_program("raw");
    envelope.mutable_hello()->set_version("0.0");
    send(envelope);
  }

  void request(const std::function<void(v1::Request&)>& fill) {
    v1::Envelope envelope;
    fill(*envelope.mutable_request());
    send(envelope);
  }

  /// The bytes of the next message, or nothing when the daemon has closed or is silent.
  std::optional<std::string> receive_bytes(std::chrono::milliseconds timeout = std::chrono::seconds(5)) {
    const auto deadline = client::Clock::now() + timeout;
    while (true) {
      if (const auto message = reader_.next()) {
        return std::string(*message);
      }
      std::vector<char> chunk(65536);
      std::size_t received = 0;
      outcome_ = socket_.receive(chunk, received, deadline);
      if (outcome_ != client::StreamSocket::Outcome::kDone) {
        return std::nullopt;
      }
      reader_.append(std::string_view(chunk.data(), received));
    }
  }

  std::optional<v1::Envelope> receive(std::chrono::milliseconds timeout = std::chrono::seconds(5)) {
    const auto bytes = receive_bytes(timeout);
    v1::Envelope envelope;
    if (!bytes || !envelope.ParseFromString(*bytes)) {
      return std::nullopt;
    }
    return envelope;
  }

  /// Whether the last receive ended because the daemon closed.
  bool is_closed() const noexcept { return outcome_ == client::StreamSocket::Outcome::kClosed; }

 private:
  client::StreamSocket socket_;
  proto::FrameReader reader_{proto::kReplyLimit};
  client::StreamSocket::Outcome outcome_ = client::StreamSocket::Outcome::kDone;
};

}  // namespace haptic::test
