#pragma once
// Passes on what a daemon tells its observers to a NATS server. Two threads: one reads from the daemon and
// never waits for the broker, the other publishes; the outbox is between them. Both connect again whenever
// they must.
//
//     daemon --> reader --> [outbox] --> publisher --> broker --> any number of subscribers
//                  |                       ^
//                  +---> scene, status ----+--<-- requests

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "client/bridge/broker.h"
#include "client/bridge/outbox.h"
#include "client/lib/connection.h"

namespace haptic::bridge {

struct Options {
  client::Options daemon;
  BrokerOptions broker;
  std::string host;  // in the subjects
  std::vector<v1::Topic> topics;
  std::uint32_t decimation = 1;  // ticks for each frame; events and statistics come as they are
  Keep keep = Keep::kLatest;     // of objects, HIPs and devices; of events and statistics all wait
  std::size_t buffer = std::size_t{8} * 1024 * 1024;  // bytes that wait in each topic that keeps all
};

class Bridge {
 public:
  /// `log` takes a line for a person; both threads call it, one at a time. Throws BrokerError if the broker's
  /// options cannot be used.
  Bridge(Options options, std::function<void(const std::string&)> log);
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;
  ~Bridge() { stop(); }

  /// Reads no more, publishes what waits and a last status, and flushes; gives up after some seconds.
  void stop();

  v1::BridgeStatus status() const;

 private:
  using Clock = std::chrono::steady_clock;

  // the reader's
  void read(const std::stop_token& stop);
  void read_session(const std::stop_token& stop);
  void subscribe(client::Connection& daemon);
  void pass_on(const v1::Envelope& message, client::Connection& daemon);
  void fetch_scene(client::Connection& daemon);
  std::size_t lane_of(std::uint32_t subscription) const;

  // the publisher's
  void publish(const std::stop_token& stop);
  void publish_session(const std::stop_token& stop);
  void open_broker();
  bool is_broker_there();
  void publish_some(std::chrono::milliseconds patience);
  void publish_scene_and_status();
  void send(const Outgoing& message);
  bool send(const std::string& subject, const std::string& payload);
  void finish();

  void set_link(bool is_daemon, bool connected, const std::string& text);
  std::string status_bytes(bool ending) const;
  std::string scene_bytes() const;

  const Options options_;
  const std::function<void(const std::string&)> log_;
  const Clock::time_point start_ = Clock::now();
  Outbox outbox_;

  mutable std::mutex mutex_;  // of the next three, and of calls of log_
  v1::BridgeStatus status_;   // without what the outbox counts
  std::string scene_;         // the last SceneDescription
  bool is_scene_due_ = false;

  std::vector<std::uint32_t> subscriptions_;  // of each topic; the reader's
  std::uint64_t scene_revision_ = 0;

  std::unique_ptr<Broker> broker_;      // the publisher's
  std::uint64_t seen_connections_ = 0;  // of broker_
  Clock::time_point next_status_ = start_;
  bool has_told_size_ = false;

  std::jthread reader_;
  std::jthread publisher_;
};

}  // namespace haptic::bridge
