#include "client/view/beast_socket.h"

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <utility>

namespace haptic::gateway {
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;

namespace {

using Request = http::request<http::empty_body>;

constexpr std::size_t kReasonBytes = 123;  // all that a close frame holds

// so many bytes of UTF-8 at the most, and no part of a character
std::string_view beginning_of(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) {
    return text;
  }
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xc0U) == 0x80U) {
    --bytes;
  }
  return text.substr(0, bytes);
}

class BeastSocket final : public WebSocket, public std::enable_shared_from_this<BeastSocket> {
 public:
  BeastSocket(AnyStream stream, const WebSettings& settings, Seat connection, Seat socket)
      : stream_(std::move(stream)),
        timer_(stream_.get_executor()),
        goodbye_(settings.goodbye),
        connection_(std::move(connection)),
        socket_(std::move(socket)) {
    beast::get_lowest_layer(stream_).expires_never();  // it has time-outs of its own
    stream_.set_option(websocket::stream_base::timeout{settings.request, settings.idle, true});
    stream_.read_message_max(settings.message_bytes);
    stream_.auto_fragment(false);
  }

  void accept(const Request& request, const std::string& subprotocol, std::function<void()> on_accepted) {
    stream_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
      response.set(http::field::server, "haptic-view");
      response.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    stream_.async_accept(
        request, [self = shared_from_this(), on_accepted = std::move(on_accepted)](const error_code& error) {
          if (!error) {
            on_accepted();
          }
        });
  }

  void on_end(std::function<void()> on_end) override { on_end_ = std::move(on_end); }

  void read(OnMessage on_message) override {
    if (ended_) {
      return;
    }
    stream_.async_read(buffer_, [self = shared_from_this(), on_message = std::move(on_message)](
                                    const error_code& error, std::size_t) {
      if (error) {
        self->end();
        return;
      }
      if (self->ended_ || self->closing_) {
        return;
      }
      const auto bytes = self->buffer_.cdata();
      const std::string message(static_cast<const char*>(bytes.data()), bytes.size());
      self->buffer_.clear();
      on_message(message, self->stream_.got_binary());
    });
  }

  void write(Outgoing message, std::function<void()> on_written) override {
    if (ended_ || closing_) {
      return;
    }
    writing_ = std::move(message);
    stream_.binary(writing_.payload != nullptr);
    const std::array<asio::const_buffer, 2> buffers = {
        asio::buffer(writing_.head),
        writing_.payload ? asio::buffer(*writing_.payload) : asio::const_buffer()};
    stream_.async_write(buffers, [self = shared_from_this(), on_written = std::move(on_written)](
                                     const error_code& error, std::size_t) {
      self->writing_ = {};
      if (error) {
        self->end();
      } else if (!self->ended_ && !self->closing_) {
        on_written();
      }
    });
  }

  void close(CloseCode code, std::string_view reason) override {
    if (ended_ || closing_) {
      return;
    }
    closing_ = true;
    timer_.expires_after(goodbye_);
    timer_.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error) {
        self->end();
      }
    });
    const std::string_view text = beginning_of(reason, kReasonBytes);
    const websocket::close_reason why(static_cast<websocket::close_code>(code),
                                      beast::string_view(text.data(), text.size()));
    stream_.async_close(why, [self = shared_from_this()](const error_code&) { self->end(); });
  }

 private:
  void end() {
    if (ended_) {
      return;
    }
    ended_ = true;
    timer_.cancel();
    beast::get_lowest_layer(stream_).close();
    connection_.reset();
    socket_.reset();
    if (const auto on_end = std::exchange(on_end_, nullptr)) {
      on_end();
    }
  }

  websocket::stream<AnyStream, false> stream_;  // without compression
  asio::steady_timer timer_;                    // for the goodbye
  std::chrono::milliseconds goodbye_;
  Seat connection_;
  Seat socket_;
  std::function<void()> on_end_;
  beast::flat_buffer buffer_;
  Outgoing writing_;
  bool closing_ = false;
  bool ended_ = false;
};

}  // namespace

void accept_socket(AnyStream stream, const Request& request, const std::string& subprotocol,
                   const WebSettings& settings, Seat connection, Seat socket,
                   std::function<void(std::shared_ptr<WebSocket>)> on_accepted) {
  const auto accepted =
      std::make_shared<BeastSocket>(std::move(stream), settings, std::move(connection), std::move(socket));
  accepted->accept(request, subprotocol,
                   [accepted, on_accepted = std::move(on_accepted)] { on_accepted(accepted); });
}

}  // namespace haptic::gateway
