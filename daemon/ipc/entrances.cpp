#include "ipc/entrances.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <list>
#include <optional>
#include <utility>

#include "ipc/listen_socket.h"
#include "ipc/tls.h"

namespace haptic::ipc {
namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kAcceptPause{100};  // after an error, as when descriptors have run out

using Local = asio::local::stream_protocol;
using Tcp = asio::ip::tcp;
using SteadyClock = std::chrono::steady_clock;

std::vector<v1::Listen> or_default(std::vector<v1::Listen> listen) {
  if (listen.empty()) {
    listen.emplace_back().mutable_unix()->clear_path();
  }
  return listen;
}

}  // namespace

class Entrances::Impl {
 public:
  Impl(asio::io_context& io, const ServerSettings& settings, OnClient on_client)
      : io_(io), settings_(settings), on_client_(std::move(on_client)) {
    std::vector<Passed> passed = take(settings_.passed_sockets);
    for (const v1::Listen& listen : or_default(settings_.listen)) {
      listen_at(listen, passed);
    }
    if (!passed.empty()) {
      throw ListenError("the service manager passes a socket at " + passed.front().path +
                        ", but no listen.unix of the config has that path; name it there, or change " +
                        "ListenStream= of the socket unit");
    }
  }

  void open() {
    for (auto& entrance : local_) {
      accept(entrance);
    }
    for (auto& entrance : tcp_) {
      accept(entrance);
    }
  }

  void close() {
    is_closed_ = true;
    error_code ignored;
    for (auto& entrance : local_) {
      entrance.acceptor.close(ignored);
      entrance.pause.cancel();
    }
    for (auto& entrance : tcp_) {
      entrance.acceptor.close(ignored);
      entrance.pause.cancel();
    }
  }

  std::function<void()> prepare(const std::vector<v1::Listen>& wanted) {
    const auto changes = std::make_shared<std::list<Change>>();
    for (const v1::Listen& listen : or_default(wanted)) {
      prepare(listen, *changes);
    }
    return [changes] {
      for (Change& change : *changes) {
        apply(change);
      }
    };
  }

  const std::vector<std::string>& addresses() const noexcept { return addresses_; }

 private:
  // a way in, and what decides about who comes
  template <class Protocol>
  struct Entrance {
    typename Protocol::acceptor acceptor;
    asio::steady_timer pause;
    const v1::Listen listen;               // as it was opened
    UnixListener* listener;                // of a Unix socket
    std::optional<Authoriser> authoriser;  // of a Unix socket
    std::unique_ptr<TlsContext> tls;       // of TCP; none: observing only
    std::vector<v1::Listen::AllowName> allow{};
  };

  // what a reload gives to an entrance
  struct Change {
    Entrance<Local>* local = nullptr;
    Entrance<Tcp>* tcp = nullptr;
    std::optional<Authoriser> authoriser{};
    std::unique_ptr<TlsContext> tls{};
    std::vector<v1::Listen::AllowName> allow{};
  };

  struct Passed {
    std::string path;
    Descriptor socket;
  };

  static std::vector<Passed> take(const std::vector<int>& sockets) {
    std::vector<Passed> passed;
    passed.reserve(sockets.size());
    for (const int socket : sockets) {
      passed.push_back({"", Descriptor(socket)});
    }
    for (Passed& each : passed) {
      each.path = path_of_passed(each.socket.get());
    }
    return passed;
  }

  void listen_at(const v1::Listen& listen, std::vector<Passed>& passed) {
    if (listen.has_tcp()) {
      const int socket = listen_tcp(listen.tcp());
      const auto family = listen.tcp().address().find(':') == std::string::npos ? Tcp::v4() : Tcp::v6();
      Entrance<Tcp>& entrance =
          tcp_.emplace_back(Entrance<Tcp>{Tcp::acceptor(io_, family, socket), asio::steady_timer(io_), listen,
                                          nullptr, std::nullopt, nullptr});
      if (listen.tcp().has_tls()) {
        entrance.tls = std::make_unique<TlsContext>(listen.tcp().tls());
        entrance.allow.assign(listen.tcp().allow().begin(), listen.tcp().allow().end());
      }
      const auto endpoint = entrance.acceptor.local_endpoint();
      addresses_.push_back(listen.tcp().address() + ":" + std::to_string(endpoint.port()));
      return;
    }
    Authoriser authoriser = authorise(listen.unix());
    UnixListener& listener = listen_unix(listen.unix(), passed);
    local_.push_back({Local::acceptor(io_, Local(), listener.release()), asio::steady_timer(io_), listen,
                      &listener, std::move(authoriser), nullptr});
    addresses_.push_back(listener.path());
  }

  UnixListener& listen_unix(const v1::Listen::Unix& config, std::vector<Passed>& passed) {
    const std::string path = config.path().empty() && !passed.empty() ? default_socket_path() : config.path();
    const auto found =
        std::find_if(passed.begin(), passed.end(), [&](const Passed& each) { return each.path == path; });
    if (found == passed.end()) {
      return listeners_.emplace_back(config);
    }
    UnixListener& listener = listeners_.emplace_back(config, std::move(found->socket));
    passed.erase(found);
    return listener;
  }

  void prepare(const v1::Listen& listen, std::list<Change>& changes) {
    for (Entrance<Local>& entrance : local_) {
      if (!listen.has_tcp() && entrance.listen.unix().path() == listen.unix().path()) {
        changes.push_back({.local = &entrance, .authoriser = authorise(listen.unix())});
      }
    }
    const v1::Listen::Tcp& tcp = listen.tcp();
    for (Entrance<Tcp>& entrance : tcp_) {
      const v1::Listen::Tcp& opened = entrance.listen.tcp();
      if (listen.has_tcp() && tcp.has_tls() && opened.has_tls() && opened.address() == tcp.address() &&
          opened.port() == tcp.port()) {
        changes.push_back({.tcp = &entrance,
                           .tls = std::make_unique<TlsContext>(tcp.tls()),
                           .allow = {tcp.allow().begin(), tcp.allow().end()}});
      }
    }
  }

  static void apply(Change& change) {
    if (change.local != nullptr) {
      change.local->authoriser = std::move(change.authoriser);
      change.local->listener->admit(*change.local->authoriser);
    } else {
      change.tcp->tls = std::move(change.tls);
      change.tcp->allow = std::move(change.allow);
    }
  }

  static Authoriser authorise(const v1::Listen::Unix& config) {
    try {
      return Authoriser::from_config(config);
    } catch (const std::runtime_error& error) {
      throw ListenError(error.what());
    }
  }

  template <class Protocol>
  void accept(Entrance<Protocol>& entrance) {
    entrance.acceptor.async_accept(
        [this, &entrance](const error_code& error, typename Protocol::socket socket) {
          if (!entrance.acceptor.is_open()) {
            return;
          }
          if (error) {
            tell_seldom(next_accept_log_, "cannot accept a client: " + error.message());
            entrance.pause.expires_after(kAcceptPause);
            entrance.pause.async_wait([this, &entrance](const error_code& ended) {
              if (!ended) {
                accept(entrance);
              }
            });
            return;
          }
          receive(Stream::Socket(std::move(socket)), entrance);
          accept(entrance);
        });
  }

  template <class Protocol>
  void receive(Stream::Socket socket, Entrance<Protocol>& entrance) {
    if (entrance.authoriser) {
      const std::optional<PeerCredentials> credentials = peer_credentials(socket.native_handle());
      on_client_(make_plain_stream(std::move(socket)), [this, &entrance, credentials] {
        return local_peer(credentials, *entrance.authoriser, settings_.role_of);
      });
      return;
    }
    error_code ignored;
    socket.set_option(Tcp::no_delay(true), ignored);
    if (!entrance.tls) {
      on_client_(make_plain_stream(std::move(socket)), unknown_peer);
      return;
    }
    if (handshakes_ >= settings_.clients) {
      return;  // nothing can be said before the handshake
    }
    ++handshakes_;
    const auto on_peer = [this, &entrance](EncryptedPeer peer, const std::string& error) {
      --handshakes_;
      if (!peer.stream) {
        tell_seldom(next_handshake_log_, "a client over TLS did not get in: " + error);
      } else if (!is_closed_) {
        on_client_(std::move(peer.stream), [&entrance, names = std::move(peer.names)] {
          return certified_peer(names, entrance.allow);
        });
      }
    };
    entrance.tls->handshake(std::move(socket), settings_.session.hello, on_peer);
  }

  // at most once a second: others can cause it as often as they like
  static void tell_seldom(SteadyClock::time_point& next, const std::string& warning) {
    const auto now = SteadyClock::now();
    if (now >= next) {
      spdlog::warn("{}", warning);
      next = now + std::chrono::seconds(1);
    }
  }

  asio::io_context& io_;
  const ServerSettings& settings_;
  OnClient on_client_;
  std::list<UnixListener> listeners_;
  std::list<Entrance<Local>> local_;
  std::list<Entrance<Tcp>> tcp_;
  std::vector<std::string> addresses_;
  std::size_t handshakes_ = 0;  // of TLS, under way
  SteadyClock::time_point next_accept_log_{};
  SteadyClock::time_point next_handshake_log_{};
  bool is_closed_ = false;
};

Entrances::Entrances(asio::io_context& io, const ServerSettings& settings, OnClient on_client)
    : impl_(std::make_unique<Impl>(io, settings, std::move(on_client))) {}
Entrances::~Entrances() = default;
void Entrances::open() { impl_->open(); }
void Entrances::close() { impl_->close(); }
std::function<void()> Entrances::prepare(const std::vector<v1::Listen>& listen) {
  return impl_->prepare(listen);
}
const std::vector<std::string>& Entrances::addresses() const noexcept { return impl_->addresses(); }

}  // namespace haptic::ipc
