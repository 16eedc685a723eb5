#pragma once
// A browser's bytes, over TCP or over TLS, as one type, so that all of Beast that is above them is made once.
// It is what Beast calls an AsyncStream. Whatever is under way ends with an error when its time is over.
// io thread.

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/role.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace haptic::gateway {

class AnyStream {
 public:
  using executor_type = boost::asio::any_io_executor;  // NOLINT(readability-identifier-naming): Asio's name
  using OnBytes = std::function<void(const boost::system::error_code&, std::size_t)>;
  using OnDone = std::function<void(const boost::system::error_code&)>;
  using Input = std::vector<boost::asio::mutable_buffer>;
  using Output = std::vector<boost::asio::const_buffer>;

  /// `tls`: none for plain TCP; must stay.
  AnyStream(boost::asio::ip::tcp::socket socket, boost::asio::ssl::context* tls);
  AnyStream(AnyStream&&) noexcept;
  AnyStream& operator=(AnyStream&&) noexcept;
  ~AnyStream();

  /// Agrees on keys, if there are any to agree on.
  void handshake(OnDone on_done);
  /// The browser sees an end after what was written.
  void end_writing(OnDone on_done);
  void close() noexcept;

  /// For what begins from now on.
  void expires_after(std::chrono::milliseconds time);
  void expires_never();

  executor_type get_executor() noexcept;

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    read_some(Input(boost::asio::buffer_sequence_begin(buffers), boost::asio::buffer_sequence_end(buffers)),
              erased(std::forward<Handler>(handler)));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    write_some(Output(boost::asio::buffer_sequence_begin(buffers), boost::asio::buffer_sequence_end(buffers)),
               erased(std::forward<Handler>(handler)));
  }

  class Layer;

 private:
  // Beast's handlers can be moved only
  template <class Handler>
  static OnBytes erased(Handler&& handler) {
    auto kept = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler));
    return [kept = std::move(kept)](const boost::system::error_code& error, std::size_t size) {
      auto own = std::move(*kept);
      own(error, size);
    };
  }

  void read_some(const Input& buffers, OnBytes on_bytes);
  void write_some(const Output& buffers, OnBytes on_bytes);

  std::unique_ptr<Layer> layer_;
};

/// Beast calls it when a WebSocket's time is over.
inline void beast_close_socket(AnyStream& stream) { stream.close(); }

/// Beast calls it when a WebSocket has ended in peace.
template <class Handler>
void async_teardown(boost::beast::role_type /*role*/, AnyStream& stream, Handler&& handler) {
  auto kept = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler));
  stream.end_writing([kept = std::move(kept)](const boost::system::error_code& error) {
    auto own = std::move(*kept);
    own(error);
  });
}

}  // namespace haptic::gateway
