#include "client/view/any_stream.h"

#include <boost/asio/post.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

namespace haptic::gateway {
namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;

class AnyStream::Layer {
 public:
  Layer() = default;
  Layer(const Layer&) = delete;
  Layer& operator=(const Layer&) = delete;
  virtual ~Layer() = default;
  virtual void handshake(OnDone on_done) = 0;
  virtual void end_writing(OnDone on_done) = 0;
  virtual beast::tcp_stream& tcp() noexcept = 0;
  virtual void read_some(const Input& buffers, OnBytes on_bytes) = 0;
  virtual void write_some(const Output& buffers, OnBytes on_bytes) = 0;
};

namespace {

class PlainLayer final : public AnyStream::Layer {
 public:
  explicit PlainLayer(asio::ip::tcp::socket socket) : stream_(std::move(socket)) {}

  void handshake(AnyStream::OnDone on_done) override {
    asio::post(stream_.get_executor(), [on_done = std::move(on_done)] { on_done({}); });
  }
  void end_writing(AnyStream::OnDone on_done) override {
    error_code error;
    stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, error);
    asio::post(stream_.get_executor(), [error, on_done = std::move(on_done)] { on_done(error); });
  }
  beast::tcp_stream& tcp() noexcept override { return stream_; }
  void read_some(const AnyStream::Input& buffers, AnyStream::OnBytes on_bytes) override {
    stream_.async_read_some(buffers, std::move(on_bytes));
  }
  void write_some(const AnyStream::Output& buffers, AnyStream::OnBytes on_bytes) override {
    stream_.async_write_some(buffers, std::move(on_bytes));
  }

 private:
  beast::tcp_stream stream_;
};

class TlsLayer final : public AnyStream::Layer {
 public:
  TlsLayer(asio::ip::tcp::socket socket, asio::ssl::context& tls)
      : stream_(beast::tcp_stream(std::move(socket)), tls) {}

  void handshake(AnyStream::OnDone on_done) override {
    stream_.async_handshake(asio::ssl::stream_base::server, std::move(on_done));
  }
  void end_writing(AnyStream::OnDone on_done) override { stream_.async_shutdown(std::move(on_done)); }
  beast::tcp_stream& tcp() noexcept override { return beast::get_lowest_layer(stream_); }
  void read_some(const AnyStream::Input& buffers, AnyStream::OnBytes on_bytes) override {
    stream_.async_read_some(buffers, std::move(on_bytes));
  }
  void write_some(const AnyStream::Output& buffers, AnyStream::OnBytes on_bytes) override {
    stream_.async_write_some(buffers, std::move(on_bytes));
  }

 private:
  beast::ssl_stream<beast::tcp_stream> stream_;
};

std::unique_ptr<AnyStream::Layer> make_layer(asio::ip::tcp::socket socket, asio::ssl::context* tls) {
  if (tls != nullptr) {
    return std::make_unique<TlsLayer>(std::move(socket), *tls);
  }
  return std::make_unique<PlainLayer>(std::move(socket));
}

}  // namespace

AnyStream::AnyStream(asio::ip::tcp::socket socket, asio::ssl::context* tls)
    : layer_(make_layer(std::move(socket), tls)) {}
AnyStream::AnyStream(AnyStream&&) noexcept = default;
AnyStream& AnyStream::operator=(AnyStream&&) noexcept = default;
AnyStream::~AnyStream() = default;

void AnyStream::handshake(OnDone on_done) { layer_->handshake(std::move(on_done)); }
void AnyStream::end_writing(OnDone on_done) { layer_->end_writing(std::move(on_done)); }
void AnyStream::close() noexcept { layer_->tcp().close(); }
void AnyStream::expires_after(std::chrono::milliseconds time) { layer_->tcp().expires_after(time); }
void AnyStream::expires_never() { layer_->tcp().expires_never(); }
AnyStream::executor_type AnyStream::get_executor() noexcept { return layer_->tcp().get_executor(); }
void AnyStream::read_some(const Input& buffers, OnBytes on_bytes) {
  layer_->read_some(buffers, std::move(on_bytes));
}
void AnyStream::write_some(const Output& buffers, OnBytes on_bytes) {
  layer_->write_some(buffers, std::move(on_bytes));
}

}  // namespace haptic::gateway
