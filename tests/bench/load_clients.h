#pragma once
// Clients in numbers: many that read frames on one thread, and some that are a nuisance on threads of theirs.

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "client/lib/stream_socket.h"
#include "haptic/v1/control.pb.h"
#include "proto/framing.h"

namespace haptic::bench {

/// What the frames of all clients together were.
struct Arrivals {
  std::vector<std::uint64_t> latencies_ns;  // from the tick's clock to the arrival
  std::uint64_t bytes = 0;
  std::uint64_t lost = 0;  // frames that gaps told of

  /// The quantile `part`; 0 if no frame came.
  std::uint64_t latency(double part) const;
};

class Swarm {
 public:
  /// Each client subscribes to all of each `decimation`-th tick. The last `stalled` of them never read.
  Swarm(const std::string& socket, std::size_t clients, std::uint32_t decimation, std::size_t stalled);
  Swarm(const Swarm&) = delete;
  Swarm& operator=(const Swarm&) = delete;
  ~Swarm();

  /// Reads whatever comes. What had come before counts for nothing.
  void read_for(std::chrono::duration<double> time);
  const Arrivals& arrivals() const noexcept { return arrivals_; }

 private:
  class Reader;
  void wait(std::chrono::milliseconds timeout);

  std::vector<std::unique_ptr<Reader>> readers_;
  std::size_t stalled_;
  Arrivals arrivals_;
};

class Nuisance {
 public:
  explicit Nuisance(std::string socket) : socket_(std::move(socket)) {}

  /// Connects, says hello, waits for the answer and closes, at most so often.
  void reconnect(std::uint64_t times);
  /// Sends commands at the rate that the daemon takes of one client, with at most as many unanswered.
  void flood();
  /// Returns how many reconnects there were, or commands that the daemon took. Throws std::runtime_error if
  /// it has cut the flood off, so that nothing was measured.
  std::uint64_t stop();

 private:
  std::string socket_;
  std::atomic<std::uint64_t> deeds_ = 0;
  std::atomic<bool> is_cut_off_ = false;
  std::jthread thread_;
};

}  // namespace haptic::bench
