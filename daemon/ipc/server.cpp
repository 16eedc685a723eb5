#include "ipc/server.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <list>
#include <map>
#include <utility>

#include "ipc/announcer.h"
#include "ipc/session.h"
#include "ipc/tls.h"

namespace haptic::ipc {
namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kAcceptPause{100};  // after an error, as when descriptors have run out

using Local = asio::local::stream_protocol;
using Tcp = asio::ip::tcp;

std::vector<v1::Listen> or_default(std::vector<v1::Listen> listen) {
  if (listen.empty()) {
    listen.emplace_back().mutable_unix()->clear_path();
  }
  return listen;
}

}  // namespace

class Server::Impl {
 public:
  Impl(ServerSettings settings, Services services)
      : settings_(std::move(settings)),
        services_(std::move(services)),
        announcer_(services_.devices, [this](const v1::Event& event) { broadcast(event); }),
        servo_(services_.mailbox, settings_.servo_patience,
               [this](const servo::Event& event) { take_event(event); }),
        scenes_(services_, servo_),
        lease_(settings_.drive, servo_),
        desk_{services_, servo_, scenes_, publisher_, SteadyClock::now(), [this] { return count_clients(); },
              lease_},
        poll_timer_(io_),
        stop_timer_(io_) {
    publisher_.learn(scenes_.current());
    for (const v1::Listen& listen : or_default(settings_.listen)) {
      open(listen);
    }
  }

  void run() {
    for (auto& acceptor : local_acceptors_) {
      accept(acceptor);
    }
    for (auto& acceptor : tcp_acceptors_) {
      accept(acceptor);
    }
    poll();
    io_.run();
  }

  void stop() {
    asio::post(io_, [this] { leave(); });
  }

  const std::vector<std::string>& addresses() const noexcept { return addresses_; }

 private:
  // a way in, and what decides about who comes
  template <class Protocol>
  struct Entrance {
    typename Protocol::acceptor acceptor;
    asio::steady_timer pause;
    std::optional<Authoriser> authoriser;  // of a Unix socket
    std::unique_ptr<TlsContext> tls;       // of TCP; none: observing only
    std::vector<v1::Listen::AllowName> allow{};
  };

  void open(const v1::Listen& listen) {
    if (listen.has_tcp()) {
      const int socket = listen_tcp(listen.tcp());
      const auto family = listen.tcp().address().find(':') == std::string::npos ? Tcp::v4() : Tcp::v6();
      Entrance<Tcp>& entrance = tcp_acceptors_.emplace_back(
          Entrance<Tcp>{Tcp::acceptor(io_, family, socket), asio::steady_timer(io_), std::nullopt, nullptr});
      if (listen.tcp().has_tls()) {
        entrance.tls = std::make_unique<TlsContext>(listen.tcp().tls());
        entrance.allow.assign(listen.tcp().allow().begin(), listen.tcp().allow().end());
      }
      const auto endpoint = entrance.acceptor.local_endpoint();
      addresses_.push_back(listen.tcp().address() + ":" + std::to_string(endpoint.port()));
      return;
    }
    Authoriser authoriser = authorise(listen.unix());
    UnixListener& listener = listeners_.emplace_back(listen.unix());
    local_acceptors_.push_back({Local::acceptor(io_, Local(), listener.release()), asio::steady_timer(io_),
                                std::move(authoriser), nullptr});
    addresses_.push_back(listener.path());
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
            spdlog::warn("cannot accept a client: {}", error.message());
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
      Peer peer = local_peer(socket.native_handle(), *entrance.authoriser, settings_.role_of);
      welcome(make_plain_stream(std::move(socket)), std::move(peer));
      return;
    }
    error_code ignored;
    socket.set_option(Tcp::no_delay(true), ignored);
    if (!entrance.tls) {
      welcome(make_plain_stream(std::move(socket)), unknown_peer());
      return;
    }
    if (handshakes_ >= settings_.clients) {
      return;  // nothing can be said before the handshake
    }
    ++handshakes_;
    const auto on_peer = [this, &entrance](EncryptedPeer peer, const std::string& error) {
      --handshakes_;
      if (!peer.stream) {
        tell_handshake(error);
      } else if (!leaving_) {
        welcome(std::move(peer.stream), certified_peer(peer.names, entrance.allow));
      }
    };
    entrance.tls->handshake(std::move(socket), settings_.session.hello, on_peer);
  }

  // at most once a second: anybody on the network can cause it
  void tell_handshake(const std::string& error) {
    const auto now = SteadyClock::now();
    if (now >= next_handshake_log_) {
      spdlog::warn("a client over TLS did not get in: {}", error);
      next_handshake_log_ = now + std::chrono::seconds(1);
    }
  }

  void welcome(std::shared_ptr<Stream> stream, Peer peer) {
    const ClientId id = ++last_client_;
    const std::string user = peer.user;
    const auto session = std::make_shared<Session>(id, std::move(stream), std::move(peer), settings_.session,
                                                   desk_, [this](ClientId ended) { forget(ended); });
    sessions_.emplace(id, session);
    session->start();
    const auto of_user = static_cast<std::size_t>(std::count_if(
        sessions_.begin(), sessions_.end(), [&](const auto& entry) { return entry.second->user() == user; }));
    if (sessions_.size() > settings_.clients) {
      session->cut_off(make_error(v1::Error::BUSY, std::to_string(settings_.clients) +
                                                       " clients are connected, and no more are taken"));
    } else if (of_user > settings_.clients_per_user) {
      session->cut_off(
          make_error(v1::Error::BUSY, std::to_string(settings_.clients_per_user) +
                                          " clients of yours are connected, and no more are taken"));
    }
  }

  void forget(ClientId id) {
    // the session may be in the middle of its own function
    asio::post(io_, [this, id] {
      sessions_.erase(id);
      if (leaving_ && sessions_.empty()) {
        io_.stop();
      }
    });
  }

  void poll() {
    const auto now = SteadyClock::now();
    scenes_.keep_scenes(publisher_.has_subscription_for(v1::INPUTS));
    servo_.poll(now);
    scenes_.poll(now);
    announcer_.poll(now);
    lease_.poll(now);
    // the event that a scene runs was sent before the first snapshot of it
    publisher_.drain(services_.mailbox.snapshots, [this, now] { servo_.poll(now); });
    tell_armed();
    publish_stats();
    poll_timer_.expires_after(settings_.poll_period);
    poll_timer_.async_wait([this](const error_code& error) {
      if (!error) {
        poll();
      }
    });
  }

  void tell_armed() {
    const bool armed = publisher_.latest().armed;
    if (armed != was_armed_ && services_.armed_changed) {
      services_.armed_changed(armed);
    }
    was_armed_ = armed;
  }

  void publish_stats() {
    services_.mailbox.stats.update();
    const servo::LoopStats& stats = services_.mailbox.stats.latest();
    if (stats.tick != last_stats_tick_ && publisher_.has_subscription_for(v1::STATS)) {
      publisher_.publish(to_wire(stats, services_.rate_hz, services_.mailbox.snapshots.lost()));
    }
    last_stats_tick_ = stats.tick;
  }

  void take_event(const servo::Event& event) {
    const bool is_fault_or_miss =
        event.kind == servo::EventKind::kFaultLatched || event.kind == servo::EventKind::kTicksMissed;
    if (!is_fault_or_miss && event.command == servo::CommandKind::kSwapScene) {
      scenes_.swapped(event.kind == servo::EventKind::kDone);
      publisher_.learn(scenes_.current());
    }
    announcer_.announce(event, scenes_.current(), SteadyClock::now());
  }

  void broadcast(const v1::Event& event) {
    v1::Envelope envelope;
    *envelope.mutable_event() = event;
    std::string bytes;
    proto::append_frame(envelope, bytes);
    for (const auto& [id, session] : sessions_) {
      session->tell(bytes);
    }
    publisher_.publish(event);
  }

  std::size_t count_clients() const {
    std::size_t count = 0;
    for (const auto& [id, session] : sessions_) {
      count += session->is_serving() ? 1U : 0U;
    }
    return count;
  }

  void leave() {
    leaving_ = true;
    error_code ignored;
    for (auto& entrance : local_acceptors_) {
      entrance.acceptor.close(ignored);
      entrance.pause.cancel();
    }
    for (auto& entrance : tcp_acceptors_) {
      entrance.acceptor.close(ignored);
      entrance.pause.cancel();
    }
    if (sessions_.empty()) {
      io_.stop();
      return;
    }
    for (const auto& [id, session] : sessions_) {
      session->cut_off(make_error(v1::Error::FAILED, "hapticd stops"));
    }
    stop_timer_.expires_after(settings_.session.goodbye * 2);
    stop_timer_.async_wait([this](const error_code& error) {
      if (!error) {
        io_.stop();
      }
    });
  }

  ServerSettings settings_;
  Services services_;
  Announcer announcer_;
  ServoLink servo_;
  Publisher publisher_;
  SceneStore scenes_;
  DriveLease lease_;
  Desk desk_;
  std::list<UnixListener> listeners_;
  asio::io_context io_{1};
  std::list<Entrance<Local>> local_acceptors_;
  std::list<Entrance<Tcp>> tcp_acceptors_;
  std::vector<std::string> addresses_;
  std::map<ClientId, std::shared_ptr<Session>> sessions_;
  ClientId last_client_ = 0;
  std::size_t handshakes_ = 0;  // of TLS, under way
  SteadyClock::time_point next_handshake_log_{};
  asio::steady_timer poll_timer_;
  asio::steady_timer stop_timer_;
  std::uint64_t last_stats_tick_ = 0;
  bool was_armed_ = false;
  bool leaving_ = false;
};

Server::Server(ServerSettings settings, Services services)
    : impl_(std::make_unique<Impl>(std::move(settings), std::move(services))) {}
Server::~Server() = default;
void Server::run() { impl_->run(); }
void Server::stop() { impl_->stop(); }
const std::vector<std::string>& Server::addresses() const noexcept { return impl_->addresses(); }

}  // namespace haptic::ipc
