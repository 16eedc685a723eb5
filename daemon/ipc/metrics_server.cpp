#include "ipc/metrics_server.h"

#include <spdlog/spdlog.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <list>
#include <optional>
#include <set>
#include <utility>

#include "ipc/listen_socket.h"
#include "proto/metrics/exposition.h"

namespace haptic::ipc {
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;
using Tcp = asio::ip::tcp;

namespace {

constexpr std::chrono::milliseconds kAcceptPause{100};  // after an error, as when descriptors have run out

using Answer = http::response<http::string_body>;

Answer make_answer(http::status status, const std::string& text,
                   const char* type = "text/plain; charset=utf-8") {
  Answer answer{status, 11};
  answer.set(http::field::content_type, type);
  answer.set(http::field::cache_control, "no-store");
  answer.keep_alive(false);
  answer.body() = text;
  answer.prepare_payload();
  return answer;
}

/// One client, from its request to the answer.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  using OnEnd = std::function<void(const std::shared_ptr<Connection>&)>;

  Connection(Tcp::socket socket, const MetricsSettings& settings, const std::function<std::string()>& page,
             OnEnd on_end)
      : stream_(std::move(socket)),
        patience_(settings.patience),
        buffer_(settings.request_bytes),
        page_(page),
        on_end_(std::move(on_end)) {
    parser_.header_limit(static_cast<std::uint32_t>(settings.request_bytes));
    parser_.body_limit(0);
  }

  void start() {
    stream_.expires_after(patience_);
    http::async_read_header(
        stream_, buffer_, parser_,
        [self = shared_from_this()](const error_code& error, std::size_t /*bytes*/) { self->take(error); });
  }

  // what is under way is called back with an error
  void close() noexcept { stream_.close(); }

 private:
  void take(const error_code& error) {
    if (error == http::error::end_of_stream || error == beast::error::timeout ||
        error == asio::error::operation_aborted) {
      return end();
    }
    if (error && error.category() != make_error_code(http::error::bad_method).category()) return end();
    if (error) return answer(make_answer(http::status::bad_request, error.message() + "\n"));
    const auto& request = parser_.get();
    const auto target = request.target();
    const std::string path(target.substr(0, target.find('?')));
    if (path != "/metrics") {
      answer(make_answer(http::status::not_found, "there is /metrics only\n"));
    } else if (request.method() != http::verb::get) {
      Answer refusal = make_answer(http::status::method_not_allowed, "GET only\n");
      refusal.set(http::field::allow, "GET");
      answer(std::move(refusal));
    } else {
      answer(make_answer(http::status::ok, page_(), metrics::kContentType));
    }
  }

  void answer(Answer answer) {
    answer_ = std::move(answer);
    stream_.expires_after(patience_);
    http::async_write(
        stream_, *answer_,
        [self = shared_from_this()](const error_code& /*error*/, std::size_t /*bytes*/) { self->end(); });
  }

  void end() {
    error_code ignored;
    stream_.socket().shutdown(Tcp::socket::shutdown_both, ignored);
    stream_.close();
    on_end_(shared_from_this());
  }

  beast::tcp_stream stream_;
  std::chrono::milliseconds patience_;
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> parser_;
  const std::function<std::string()>& page_;
  std::optional<Answer> answer_;
  OnEnd on_end_;
};

struct Entrance {
  Tcp::acceptor acceptor;
  asio::steady_timer pause;
};

std::string in_words(const Tcp::endpoint& endpoint) {
  const std::string host = endpoint.address().to_string();
  return "http://" + (endpoint.address().is_v6() ? "[" + host + "]" : host) + ":" +
         std::to_string(endpoint.port()) + "/metrics";
}

}  // namespace

class MetricsServer::Impl : public std::enable_shared_from_this<Impl> {
 public:
  Impl(asio::io_context& io, const MetricsSettings& settings, std::function<std::string()> page)
      : io_(io), settings_(settings), page_(std::move(page)) {
    const auto port = static_cast<unsigned short>(settings.port);
    open({asio::ip::address_v4::loopback(), port});
    // the same where the system has chosen it
    const unsigned short chosen = entrances_.front().acceptor.local_endpoint().port();
    try {
      open({asio::ip::address_v6::loopback(), chosen});
    } catch (const ListenError& error) {
      spdlog::info("{}; the numbers are told on 127.0.0.1 only", error.what());
    }
  }

  void start() {
    for (Entrance& entrance : entrances_) accept(entrance);
  }

  void stop() {
    for (Entrance& entrance : entrances_) {
      error_code ignored;
      entrance.acceptor.close(ignored);
      entrance.pause.cancel();
    }
    for (const auto& connection : connections_) connection->close();
  }

  const std::vector<std::string>& addresses() const noexcept { return addresses_; }

 private:
  void open(const Tcp::endpoint& endpoint) {
    Tcp::acceptor acceptor(io_);
    try {
      acceptor.open(endpoint.protocol());
      acceptor.set_option(Tcp::acceptor::reuse_address(true));
      if (endpoint.address().is_v6()) acceptor.set_option(asio::ip::v6_only(true));
      acceptor.bind(endpoint);
      acceptor.listen();
      addresses_.push_back(in_words(acceptor.local_endpoint()));
    } catch (const boost::system::system_error& error) {
      throw ListenError("metrics.port: cannot listen on " + in_words(endpoint) + ": " +
                        error.code().message());
    }
    entrances_.push_back({std::move(acceptor), asio::steady_timer(io_)});
  }

  void accept(Entrance& entrance) {
    const auto on_client = [self = shared_from_this(), &entrance](const error_code& error,
                                                                  Tcp::socket socket) {
      if (!entrance.acceptor.is_open()) return;
      if (error) return self->accept_later(entrance);
      self->serve(std::move(socket));
      self->accept(entrance);
    };
    entrance.acceptor.async_accept(on_client);
  }

  void accept_later(Entrance& entrance) {
    entrance.pause.expires_after(kAcceptPause);
    entrance.pause.async_wait([self = shared_from_this(), &entrance](const error_code& error) {
      if (!error) self->accept(entrance);
    });
  }

  // beyond the few, the socket is closed as it goes
  void serve(Tcp::socket socket) {
    if (connections_.size() >= settings_.connections) return;
    const auto connection = std::make_shared<Connection>(
        std::move(socket), settings_, page_,
        [this](const std::shared_ptr<Connection>& ended) { connections_.erase(ended); });
    connections_.insert(connection);
    connection->start();
  }

  asio::io_context& io_;
  MetricsSettings settings_;
  std::function<std::string()> page_;
  std::list<Entrance> entrances_;
  std::vector<std::string> addresses_;
  std::set<std::shared_ptr<Connection>> connections_;
};

MetricsServer::MetricsServer(asio::io_context& io, const MetricsSettings& settings,
                             std::function<std::string()> page)
    : impl_(std::make_shared<Impl>(io, settings, std::move(page))) {}
MetricsServer::~MetricsServer() = default;
void MetricsServer::start() { impl_->start(); }
void MetricsServer::stop() { impl_->stop(); }
const std::vector<std::string>& MetricsServer::addresses() const noexcept { return impl_->addresses(); }

}  // namespace haptic::ipc
