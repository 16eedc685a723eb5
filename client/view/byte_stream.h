#pragma once
// Bytes to and from the daemon: over its Unix socket, over TCP, or over TLS as `hapticctl certificates` has
// it arranged. Never blocks. io thread.

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "client/lib/address.h"
#include "client/lib/tls.h"

namespace haptic::gateway {

class ByteStream {
 public:
  using OnBytes = std::function<void(const boost::system::error_code&, std::size_t)>;

  ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  virtual ~ByteStream() = default;

  /// At least one byte; `buffer` must stay until it is called back.
  virtual void read_some(boost::asio::mutable_buffer buffer, OnBytes on_bytes) = 0;
  /// All of it; what `buffer` points to must stay until it is called back.
  virtual void write(boost::asio::const_buffer buffer, OnBytes on_bytes) = 0;
  /// What is under way is called back with an error.
  virtual void close() noexcept = 0;
};

/// The way to one daemon.
class DaemonDoor {
 public:
  /// Called once: with the stream, or with none and why, for a person.
  using OnStream = std::function<void(std::shared_ptr<ByteStream>, const std::string& problem)>;

  /// Throws std::runtime_error if a file of the identity cannot be used.
  DaemonDoor(const std::string& address, const client::Identity& identity);
  ~DaemonDoor();
  DaemonDoor(const DaemonDoor&) = delete;
  DaemonDoor& operator=(const DaemonDoor&) = delete;

  void connect(boost::asio::io_context& io, std::chrono::milliseconds limit, OnStream on_stream) const;

  std::string name() const { return client::to_string(address_); }

 private:
  class Trust;
  client::Address address_;
  std::unique_ptr<Trust> trust_;  // of TLS; none: plain
};

}  // namespace haptic::gateway
