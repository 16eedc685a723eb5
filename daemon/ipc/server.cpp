#include "ipc/server.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <map>
#include <utility>

#include "ipc/announcer.h"
#include "ipc/convert.h"
#include "ipc/device_watch.h"
#include "ipc/entrances.h"
#include "ipc/flight_recorder.h"
#include "ipc/metrics_server.h"
#include "ipc/reports.h"
#include "ipc/session.h"
#include "proto/metrics/exposition.h"

namespace haptic::ipc {
namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::chrono::seconds kFlushPeriod{1};  // of the log

}  // namespace

class Server::Impl {
 public:
  Impl(ServerSettings settings, Services services)
      : settings_(std::move(settings)),
        services_(std::move(services)),
        announcer_(services_.devices, [this](const v1::Event& event) { broadcast(event); }),
        servo_(services_.mailbox, settings_.servo_patience,
               [this](const servo::Event& event) { take_event(event); }),
        device_watch_(
            services_,
            [this](const v1::Event& event) { announcer_.announce(event, publisher_.latest().tick); }),
        scenes_(services_, servo_),
        lease_(settings_.drive, servo_),
        desk_{services_, servo_, scenes_, publisher_, SteadyClock::now(), [this] { return count_clients(); },
              lease_},
        entrances_(io_, settings_,
                   [this](std::shared_ptr<Stream> stream, std::function<Peer()> assess) {
                     welcome(std::move(stream), std::move(assess));
                   }),
        addresses_(entrances_.addresses()),
        poll_timer_(io_),
        stop_timer_(io_) {
    publisher_.learn(scenes_.current());
    if (!settings_.flight.directory.empty()) {
      flight_.emplace(
          settings_.flight, services_, publisher_, servo_, [this] { return report_devices(desk_); },
          [this](const std::vector<std::uint64_t>& faults, const std::string& path) {
            tell_recording(faults, path);
          });
      flight_->learn(scenes_.current(), scenes_.shared_running(), 0);
    }
    if (settings_.metrics) {
      metrics_.emplace(io_, *settings_.metrics, [this] { return make_metrics(); });
      addresses_.insert(addresses_.end(), metrics_->addresses().begin(), metrics_->addresses().end());
    }
  }

  void run() {
    entrances_.open();
    if (metrics_) {
      metrics_->start();
    }
    poll();
    io_.run();
  }

  // what can fail is done here, what clients see on the io thread
  void reload(ServerSettings settings) {
    std::function<void()> change_entrances = entrances_.prepare(settings.listen);
    asio::post(io_, [this, change_entrances = std::move(change_entrances), wanted = std::move(settings)] {
      settings_.session = wanted.session;
      settings_.clients = wanted.clients;
      settings_.clients_per_user = wanted.clients_per_user;
      lease_.set_policy(wanted.drive);
      change_entrances();
      cut_off_changed();
    });
  }

  void stop() {
    asio::post(io_, [this] { leave(); });
  }

  const std::vector<std::string>& addresses() const noexcept { return addresses_; }

 private:
  struct Client {
    std::shared_ptr<Session> session;
    std::optional<v1::Role> role;
    std::function<Peer()> assess;  // who it is by the rules of now
  };

  void cut_off_changed() {
    for (const auto& [id, client] : sessions_) {
      const Peer peer = client.assess();
      if (peer.role != client.role) {
        spdlog::info("{} is cut off: its role has changed", peer.name);
        client.session->cut_off(
            make_error(v1::Error::REFUSED, "what you may do has changed; connect again to go on"));
      }
    }
  }

  void welcome(std::shared_ptr<Stream> stream, std::function<Peer()> assess) {
    const ClientId id = ++last_client_;
    Peer peer = assess();
    const std::string user = peer.user;
    const std::optional<v1::Role> role = peer.role;
    const auto session = std::make_shared<Session>(id, std::move(stream), std::move(peer), settings_.session,
                                                   desk_, [this](ClientId ended) { forget(ended); });
    sessions_.emplace(id, Client{session, role, std::move(assess)});
    session->start();
    const auto of_user =
        static_cast<std::size_t>(std::count_if(sessions_.begin(), sessions_.end(), [&](const auto& entry) {
          return entry.second.session->user() == user;
        }));
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
    device_watch_.poll(now);
    lease_.poll(now);
    // the event that a scene runs was sent before the first snapshot of it
    publisher_.drain(services_.mailbox.snapshots, [this, now] { servo_.poll(now); });
    tell_armed();
    if (flight_) {
      flight_->poll(now);
    }
    publish_stats();
    if (now >= next_flush_) {
      spdlog::default_logger()->flush();  // tells of lines that were held back
      next_flush_ = now + kFlushPeriod;
    }
    if (services_.on_poll) {
      services_.on_poll();
    }
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
      if (flight_ && event.kind == servo::EventKind::kDone) {
        flight_->learn(scenes_.current(), scenes_.shared_running(), event.tick);
      }
    }
    remember_faults(event);
    announcer_.announce(event, scenes_.current(), SteadyClock::now());
  }

  void remember_faults(const servo::Event& event) {
    if (event.kind == servo::EventKind::kFaultLatched) {
      const v1::Fault fault = to_wire(event.fault, services_.devices);
      const std::uint64_t now = monotonic_ns();
      const std::uint64_t number =
          desk_.faults.add(fault, now, now + static_cast<std::uint64_t>(realtime_offset_ns()));
      if (flight_) {
        flight_->begin(fault, number, SteadyClock::now());
      }
    } else if (event.kind == servo::EventKind::kDone && event.command == servo::CommandKind::kClearFault) {
      desk_.faults.clear();
    }
  }

  void tell_recording(const std::vector<std::uint64_t>& faults, const std::string& path) {
    if (path.empty()) {
      return;
    }
    desk_.faults.set_recording(faults, path);
    v1::Event event;
    event.set_kind(v1::Event::FAULT_RECORDED);
    event.set_tick(publisher_.latest().tick);
    event.set_recording(path);
    event.set_message("what came before the fault is in " + path);
    announcer_.tell(event);
  }

  std::string make_metrics() const {
    return metrics::exposition({.status = report_status(desk_),
                                .devices = report_devices(desk_),
                                .stats = report_stats(desk_),
                                .faults = desk_.faults.counts()});
  }

  void broadcast(const v1::Event& event) {
    v1::Envelope envelope;
    *envelope.mutable_event() = event;
    std::string bytes;
    proto::append_frame(envelope, bytes);
    for (const auto& [id, client] : sessions_) {
      client.session->tell(bytes);
    }
    publisher_.publish(event);
  }

  std::size_t count_clients() const {
    std::size_t count = 0;
    for (const auto& [id, client] : sessions_) {
      count += client.session->is_serving() ? 1U : 0U;
    }
    return count;
  }

  void leave() {
    leaving_ = true;
    if (flight_) {
      flight_->finish();
    }
    if (metrics_) {
      metrics_->stop();
    }
    entrances_.close();
    if (sessions_.empty()) {
      io_.stop();
      return;
    }
    for (const auto& [id, client] : sessions_) {
      client.session->cut_off(make_error(v1::Error::FAILED, "hapticd stops"));
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
  DeviceWatch device_watch_;
  SceneStore scenes_;
  DriveLease lease_;
  Desk desk_;
  std::optional<FlightRecorder> flight_;
  asio::io_context io_{1};
  Entrances entrances_;
  std::optional<MetricsServer> metrics_;
  std::vector<std::string> addresses_;
  std::map<ClientId, Client> sessions_;
  ClientId last_client_ = 0;
  asio::steady_timer poll_timer_;
  asio::steady_timer stop_timer_;
  SteadyClock::time_point next_flush_{};
  std::uint64_t last_stats_tick_ = 0;
  bool was_armed_ = false;
  bool leaving_ = false;
};

Server::Server(ServerSettings settings, Services services)
    : impl_(std::make_unique<Impl>(std::move(settings), std::move(services))) {}
Server::~Server() = default;
void Server::run() { impl_->run(); }
void Server::reload(ServerSettings settings) { impl_->reload(std::move(settings)); }
void Server::stop() { impl_->stop(); }
const std::vector<std::string>& Server::addresses() const noexcept { return impl_->addresses(); }

}  // namespace haptic::ipc
