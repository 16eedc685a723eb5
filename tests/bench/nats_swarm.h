#pragma once
// Many subscribers of a NATS server on one thread. They speak its protocol themselves: the client library has
// two threads for each connection.

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "tests/bench/load_clients.h"

namespace haptic::bench {

class NatsSwarm {
 public:
  /// Each of them subscribes to Frames on `subject`. Returns when the server has taken all subscriptions;
  /// throws std::runtime_error if it does not within 60 s.
  NatsSwarm(const std::string& server, std::size_t subscribers, const std::string& subject);
  NatsSwarm(const NatsSwarm&) = delete;
  NatsSwarm& operator=(const NatsSwarm&) = delete;
  ~NatsSwarm();

  /// Reads whatever comes. What had come before counts for nothing.
  void read_for(std::chrono::duration<double> time);
  /// `lost`: holes in the sequences that subscribers saw.
  const Arrivals& arrivals() const noexcept { return arrivals_; }
  /// Subscribers that the server has ended, because they did not keep up.
  std::size_t cut_off() const noexcept { return cut_off_; }

 private:
  class Subscriber;
  void wait(std::chrono::milliseconds timeout);

  std::vector<std::unique_ptr<Subscriber>> subscribers_;
  int poll_ = -1;
  std::size_t cut_off_ = 0;
  Arrivals arrivals_;
};

}  // namespace haptic::bench
