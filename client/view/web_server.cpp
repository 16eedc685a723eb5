#include "client/view/web_server.h"

#include <openssl/ssl.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "client/view/http_connection.h"

namespace haptic::gateway {
namespace asio = boost::asio;
using boost::system::error_code;

namespace {

using Tcp = asio::ip::tcp;

constexpr std::chrono::milliseconds kAcceptPause{100};  // after an error, as when descriptors have run out

void check_tls(const std::string& file, const char* what, const error_code& error) {
  if (error) {
    throw std::runtime_error("cannot use \"" + file + "\" as the " + what + ": " + error.message());
  }
}

}  // namespace

// --- the server -------------------------------------------------------------------------------------------

class WebServer::Impl : public std::enable_shared_from_this<Impl> {
 public:
  Impl(asio::io_context& io, WebSettings settings, Log& log, OnSocket on_socket)
      : shared_(std::make_shared<WebShared>(
            WebShared{.settings = std::move(settings), .log = log, .on_socket = std::move(on_socket)})),
        acceptor_(io),
        pause_(io) {
    read_certificate();
    listen();
  }

  void accept() {
    acceptor_.async_accept([self = shared_from_this()](const error_code& error, Tcp::socket socket) {
      if (!self->acceptor_.is_open()) {
        return;
      }
      if (error) {
        self->shared_->log.tell_seldom("cannot accept a browser: " + error.message());
        self->pause_.expires_after(kAcceptPause);
        self->pause_.async_wait([self](const error_code& ended) {
          if (!ended) {
            self->accept();
          }
        });
        return;
      }
      self->receive(std::move(socket));
      self->accept();
    });
  }

  void stop() {
    shared_->stopped = true;
    error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
  }

  const std::string& url() const noexcept { return url_; }

 private:
  void read_certificate() {
    const WebSettings& settings = shared_->settings;
    if (settings.certificate.empty()) {
      return;
    }
    asio::ssl::context& tls = tls_.emplace(asio::ssl::context::tls_server);
    SSL_CTX_set_min_proto_version(tls.native_handle(), TLS1_2_VERSION);
    error_code error;
    tls.use_certificate_chain_file(settings.certificate, error);
    check_tls(settings.certificate, "certificate", error);
    tls.use_private_key_file(settings.key, asio::ssl::context::pem, error);
    check_tls(settings.key, "key of the certificate", error);
  }

  void listen() {
    const WebSettings& settings = shared_->settings;
    try {
      const Tcp::endpoint endpoint(asio::ip::make_address(settings.address), settings.port);
      acceptor_.open(endpoint.protocol());
      acceptor_.set_option(asio::socket_base::reuse_address(true));
      acceptor_.bind(endpoint);
      acceptor_.listen();
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error("cannot listen at " + settings.address + ":" + std::to_string(settings.port) +
                               ": " + error.code().message());
    }
    const Tcp::endpoint own = acceptor_.local_endpoint();
    const std::string host = own.address().is_v6() ? "[" + settings.address + "]" : settings.address;
    url_ = (tls_ ? "https://" : "http://") + host + ":" + std::to_string(own.port()) + "/";
  }

  void receive(Tcp::socket socket) {
    const Seat seat = shared_->connections;
    if (taken(shared_->connections) > shared_->settings.connections) {
      shared_->log.tell_seldom("more connections than may be are open");
      return;
    }
    error_code ignored;
    socket.set_option(Tcp::no_delay(true), ignored);
    // what waits in the system is no longer new when it gets out
    socket.set_option(asio::socket_base::send_buffer_size(static_cast<int>(shared_->settings.unsent_bytes)),
                      ignored);
    serve_http(AnyStream(std::move(socket), tls_ ? &*tls_ : nullptr), shared_, seat);
  }

  std::shared_ptr<WebShared> shared_;
  std::optional<asio::ssl::context> tls_;
  Tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  std::string url_;
};

WebServer::WebServer(asio::io_context& io, WebSettings settings, Log& log, OnSocket on_socket)
    : impl_(std::make_shared<Impl>(io, std::move(settings), log, std::move(on_socket))) {}
WebServer::~WebServer() = default;
void WebServer::start() { impl_->accept(); }
void WebServer::stop() { impl_->stop(); }
const std::string& WebServer::url() const noexcept { return impl_->url(); }

}  // namespace haptic::gateway
