#include "client/view/http_connection.h"

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <optional>
#include <string>
#include <utility>

#include "client/view/beast_socket.h"
#include "client/view/http_file.h"

namespace haptic::gateway {
namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;

namespace {

using Request = http::request<http::empty_body>;

constexpr std::uint32_t kHeaderBytes = 16 * 1024;
constexpr std::size_t kDrainedBytes = std::size_t{256} * 1024;
constexpr const char* kServer = "haptic-view";

// what the page is made of comes from here alone
constexpr const char* kContentSecurityPolicy =
    "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

beast::string_view to_beast(std::string_view text) { return {text.data(), text.size()}; }

// what came was no HTTP, in contrast to nothing at all
bool is_bad_request(const error_code& error) {
  const error_code end = http::error::end_of_stream;
  return error.category() == end.category() && error != end;
}

// all values of the subprotocols' header, in one
std::string subprotocols_of(const Request& request) {
  std::string list;
  const auto [first, last] = request.equal_range(http::field::sec_websocket_protocol);
  for (auto field = first; field != last; ++field) {
    list += (list.empty() ? "" : ",") + std::string(field->value());
  }
  return list;
}

std::optional<std::string_view> only(const Request& request, http::field name) {
  return request.count(name) == 1 ? std::optional(view_of(request[name])) : std::nullopt;
}

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(AnyStream stream, std::shared_ptr<WebShared> shared, Seat seat)
      : stream_(std::move(stream)), shared_(std::move(shared)), seat_(std::move(seat)) {}

  void start() {
    limit_time();
    stream_.handshake([self = shared_from_this()](const error_code& error) {
      if (!error) {
        self->read();
      }
    });
  }

 private:
  void limit_time() { stream_.expires_after(shared_->settings.request); }

  void read() {
    parser_.emplace();
    parser_->header_limit(kHeaderBytes);
    limit_time();
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](const error_code& error, std::size_t) {
                       if (!error && !self->shared_->stopped) {
                         self->take(self->parser_->release());
                       } else if (is_bad_request(error)) {
                         self->refuse(Request(), {400, "this is no request that can be read"});
                       }
                     });
  }

  void take(const Request& request) {
    const std::string subprotocols = subprotocols_of(request);
    const Visit visit{view_of(request.target()), only(request, http::field::host),
                      only(request, http::field::origin), subprotocols};
    if (request.count(http::field::origin) > 1) {
      refuse(request, {400, "a request has one Origin"});
    } else if (beast::websocket::is_upgrade(request)) {
      take_socket(request, visit);
    } else {
      give_file(request, visit);
    }
  }

  void take_socket(const Request& request, const Visit& visit) {
    const auto verdict = admit(visit, shared_->settings.rules);
    if (const auto* const refusal = std::get_if<Refusal>(&verdict)) {
      shared_->log.tell_seldom("a WebSocket was refused: " + refusal->reason);
      refuse(request, *refusal);
      return;
    }
    if (taken(shared_->sockets) >= shared_->settings.sockets) {
      shared_->log.tell_seldom("a WebSocket was refused: " + std::to_string(shared_->settings.sockets) +
                               " are open");
      refuse(request, {503, "as many pages as may be are open; close one"});
      return;
    }
    const auto& admission = std::get<Admission>(verdict);
    accept_socket(std::move(stream_), request, admission.subprotocol, shared_->settings, seat_,
                  shared_->sockets, [admission, shared = shared_](std::shared_ptr<WebSocket> socket) {
                    if (!shared->stopped) {
                      shared->on_socket(std::move(socket), admission);
                    }
                  });
  }

  void give_file(const Request& request, const Visit& visit) {
    const auto checked = check_visit(visit, shared_->settings.rules);
    if (const auto* const refusal = std::get_if<Refusal>(&checked)) {
      refuse(request, *refusal);
      return;
    }
    const std::string& path = std::get<Target>(checked).path;
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      refuse(request, {405, "files are only read"});
      return;
    }
    if (path == "/ws") {
      refuse(request, {426, "a WebSocket is here"});
      return;
    }
    const auto file = find_file(shared_->settings.page, path);
    http::file_body::value_type body;
    error_code error;
    if (file) {
      body.open(file->c_str(), beast::file_mode::scan, error);
    }
    if (!file || error) {
      refuse(request, {404, path == "/index.html"
                                ? "the page is not installed; --page of haptic-view tells where it is"
                                : "there is no such file"});
      return;
    }
    const auto size = body.size();
    const auto dress_file = [&](auto& response) {
      response.set(http::field::content_type, to_beast(content_type(path)));
      response.set(http::field::cache_control, to_beast(cache_control(path)));
      response.content_length(size);
      response.keep_alive(request.keep_alive());
    };
    if (request.method() == http::verb::head) {
      http::response<http::empty_body> response(http::status::ok, request.version());
      dress_file(response);
      answer(std::move(response));
      return;
    }
    http::response<http::file_body> response(std::piecewise_construct, std::make_tuple(std::move(body)),
                                             std::make_tuple(http::status::ok, request.version()));
    dress_file(response);
    answer(std::move(response));
  }

  void refuse(const Request& request, const Refusal& refusal) {
    http::response<http::string_body> response(static_cast<http::status>(refusal.status), request.version());
    response.set(http::field::content_type, "text/plain; charset=utf-8");
    response.set(http::field::cache_control, "no-store");
    if (refusal.status == 405) {
      response.set(http::field::allow, "GET, HEAD");
    }
    if (refusal.status == 426) {
      response.set(http::field::upgrade, "websocket");
    }
    if (request.method() != http::verb::head) {
      response.body() = refusal.reason + "\n";
    }
    response.keep_alive(false);
    response.prepare_payload();
    answer(std::move(response));
  }

  template <class Body>
  void answer(http::response<Body> response) {
    response.set(http::field::server, kServer);
    response.set("Content-Security-Policy", kContentSecurityPolicy);
    response.set("X-Content-Type-Options", "nosniff");
    response.set("X-Frame-Options", "DENY");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    const auto kept = std::make_shared<http::response<Body>>(std::move(response));
    stream_.expires_after(shared_->settings.answer);
    http::async_write(stream_, *kept,
                      [self = shared_from_this(), kept](const error_code& error, std::size_t) {
                        if (!error && kept->keep_alive()) {
                          self->read();
                        } else if (!error) {
                          self->finish();
                        }
                      });
  }

  // what still comes is read, so that the answer is not lost with it
  void finish() {
    stream_.expires_after(shared_->settings.goodbye);
    stream_.end_writing([self = shared_from_this()](const error_code& error) {
      if (!error) {
        self->drain(0);
      }
    });
  }

  void drain(std::size_t drained) {
    if (drained > kDrainedBytes) {
      return;
    }
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(kHeaderBytes),
                            [self = shared_from_this(), drained](const error_code& error, std::size_t size) {
                              if (!error) {
                                self->drain(drained + size);
                              }
                            });
  }

  AnyStream stream_;
  std::shared_ptr<WebShared> shared_;
  Seat seat_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
};

}  // namespace

void serve_http(AnyStream stream, std::shared_ptr<WebShared> shared, Seat seat) {
  std::make_shared<HttpConnection>(std::move(stream), std::move(shared), std::move(seat))->start();
}

}  // namespace haptic::gateway
