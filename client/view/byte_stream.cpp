#include "client/view/byte_stream.h"

#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <stdexcept>
#include <utility>

namespace haptic::gateway {
namespace asio = boost::asio;
using boost::system::error_code;

namespace {

using Socket = asio::generic::stream_protocol::socket;
using Tcp = asio::ip::tcp;
using Local = asio::local::stream_protocol;

class PlainStream final : public ByteStream {
 public:
  explicit PlainStream(Socket socket) : socket_(std::move(socket)) {}

  void read_some(asio::mutable_buffer buffer, OnBytes on_bytes) override {
    socket_.async_read_some(buffer, std::move(on_bytes));
  }
  void write(asio::const_buffer buffer, OnBytes on_bytes) override {
    asio::async_write(socket_, buffer, std::move(on_bytes));
  }
  void close() noexcept override {
    error_code ignored;
    socket_.close(ignored);
  }

 private:
  Socket socket_;
};

// what is under way refers to the stream, so each handler keeps it alive
class TlsStream final : public ByteStream, public std::enable_shared_from_this<TlsStream> {
 public:
  TlsStream(Socket socket, asio::ssl::context& context) : stream_(std::move(socket), context) {}

  void handshake(const std::string& host, std::function<void(const error_code&)> on_end) {
    error_code no_address;
    asio::ip::make_address(host, no_address);
    SSL* const ssl = stream_.native_handle();
    if (!no_address) {
      X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl), host.c_str());
    } else {
      SSL_set1_host(ssl, host.c_str());
      SSL_set_tlsext_host_name(ssl, host.c_str());
    }
    stream_.async_handshake(
        asio::ssl::stream_base::client,
        [self = shared_from_this(), on_end = std::move(on_end)](const error_code& error) { on_end(error); });
  }

  void read_some(asio::mutable_buffer buffer, OnBytes on_bytes) override {
    stream_.async_read_some(buffer,
                            [self = shared_from_this(), on_bytes = std::move(on_bytes)](
                                const error_code& error, std::size_t size) { on_bytes(error, size); });
  }
  void write(asio::const_buffer buffer, OnBytes on_bytes) override {
    asio::async_write(stream_, buffer,
                      [self = shared_from_this(), on_bytes = std::move(on_bytes)](
                          const error_code& error, std::size_t size) { on_bytes(error, size); });
  }
  void close() noexcept override {
    error_code ignored;
    stream_.lowest_layer().close(ignored);
  }

 private:
  asio::ssl::stream<Socket> stream_;
};

// one try to connect, from its beginning to its stream or its failure
class Attempt : public std::enable_shared_from_this<Attempt> {
 public:
  Attempt(asio::io_context& io, client::Address address, asio::ssl::context* trust,
          DaemonDoor::OnStream on_stream)
      : address_(std::move(address)),
        trust_(trust),
        on_stream_(std::move(on_stream)),
        timer_(io),
        resolver_(io),
        local_(io),
        tcp_(io) {}

  void start(std::chrono::milliseconds limit) {
    timer_.expires_after(limit);
    timer_.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error) {
        self->give_up();
      }
    });
    if (address_.path.empty()) {
      start_tcp();
    } else {
      start_local();
    }
  }

 private:
  void start_local() {
    if (address_.path.size() > Local::endpoint().capacity() - 1) {
      asio::post(local_.get_executor(),
                 [self = shared_from_this()] { self->fail("the path is too long for a socket"); });
      return;
    }
    local_.async_connect(Local::endpoint(address_.path),
                         [self = shared_from_this()](const error_code& error) {
                           if (error) {
                             self->fail(error.message());
                           } else {
                             self->succeed(std::make_shared<PlainStream>(Socket(std::move(self->local_))));
                           }
                         });
  }

  void start_tcp() {
    resolver_.async_resolve(address_.host, address_.port,
                            [self = shared_from_this()](const error_code& error, const auto& endpoints) {
                              if (error) {
                                self->fail(error.message());
                              } else {
                                self->connect_tcp(endpoints);
                              }
                            });
  }

  void connect_tcp(const Tcp::resolver::results_type& endpoints) {
    asio::async_connect(tcp_, endpoints,
                        [self = shared_from_this()](const error_code& error, const Tcp::endpoint&) {
                          if (error) {
                            self->fail(error.message());
                            return;
                          }
                          error_code ignored;
                          self->tcp_.set_option(Tcp::no_delay(true), ignored);
                          self->secure();
                        });
  }

  void secure() {
    if (trust_ == nullptr) {
      succeed(std::make_shared<PlainStream>(Socket(std::move(tcp_))));
      return;
    }
    tls_ = std::make_shared<TlsStream>(Socket(std::move(tcp_)), *trust_);
    tls_->handshake(address_.host, [self = shared_from_this()](const error_code& error) {
      if (error) {
        self->fail("cannot trust it: " + error.message());
      } else {
        self->succeed(self->tls_);
      }
    });
  }

  void succeed(std::shared_ptr<ByteStream> stream) {
    if (on_stream_) {
      timer_.cancel();
      std::exchange(on_stream_, nullptr)(std::move(stream), "");
    }
  }

  void fail(const std::string& why) {
    if (on_stream_) {
      timer_.cancel();
      std::exchange(on_stream_, nullptr)(nullptr, why);
    }
  }

  void give_up() {
    error_code ignored;
    resolver_.cancel();
    local_.close(ignored);
    tcp_.close(ignored);
    if (tls_) {
      tls_->close();
    }
    fail("it does not answer");
  }

  client::Address address_;
  asio::ssl::context* trust_;
  DaemonDoor::OnStream on_stream_;
  asio::steady_timer timer_;
  Tcp::resolver resolver_;
  Local::socket local_;
  Tcp::socket tcp_;
  std::shared_ptr<TlsStream> tls_;
};

void use(const char* what, const std::string& file, const error_code& error) {
  if (error) {
    throw std::runtime_error("cannot use \"" + file + "\" as the " + what +
                             " for the daemon: " + error.message());
  }
}

}  // namespace

class DaemonDoor::Trust {
 public:
  explicit Trust(const client::Identity& identity) {
    SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_3_VERSION);
    context.set_verify_mode(asio::ssl::verify_peer);
    error_code error;
    context.use_certificate_chain_file(identity.certificate, error);
    use("certificate", identity.certificate, error);
    context.use_private_key_file(identity.key, asio::ssl::context::pem, error);
    use("key", identity.key, error);
    context.load_verify_file(identity.authority, error);
    use("authority", identity.authority, error);
  }

  asio::ssl::context context{asio::ssl::context::tls_client};
};

DaemonDoor::DaemonDoor(const std::string& address, const client::Identity& identity)
    : address_(client::parse_address(address)) {
  if (address_.path.empty() && !identity.empty()) {
    trust_ = std::make_unique<Trust>(identity);
  }
}

DaemonDoor::~DaemonDoor() = default;

void DaemonDoor::connect(asio::io_context& io, std::chrono::milliseconds limit, OnStream on_stream) const {
  std::make_shared<Attempt>(io, address_, trust_ ? &trust_->context : nullptr, std::move(on_stream))
      ->start(limit);
}

}  // namespace haptic::gateway
