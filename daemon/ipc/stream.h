#pragma once
// The bytes to and from one client, over a plain socket or an encrypted one (tls.h): all that a session knows
// of how its client came. io thread.

#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace haptic::ipc {

class Stream {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;
  using OnBytes = std::function<void(const boost::system::error_code&, std::size_t)>;

  Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  virtual ~Stream() = default;

  /// At least one byte; `buffer` must stay until it is called back.
  virtual void read_some(boost::asio::mutable_buffer buffer, OnBytes on_bytes) = 0;
  /// All of it; what `buffers` point to must stay until it is called back.
  virtual void write(const std::vector<boost::asio::const_buffer>& buffers, OnBytes on_bytes) = 0;
  /// The client sees an end after what was written. Reading goes on.
  virtual void end_writing() = 0;
  /// What is under way is called back with an error.
  virtual void close() noexcept = 0;
  virtual Socket::executor_type executor() = 0;
};

std::shared_ptr<Stream> make_plain_stream(Stream::Socket socket);

}  // namespace haptic::ipc
