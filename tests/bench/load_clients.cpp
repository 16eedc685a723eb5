#include "tests/bench/load_clients.h"

#include <poll.h>
#include <time.h>

#include <algorithm>
#include <stdexcept>

#include "ipc/session_limits.h"
#include "proto/protocol.h"
#include "tests/support/raw_client.h"

namespace haptic::bench {
namespace {

std::uint64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000U + static_cast<std::uint64_t>(now.tv_nsec);
}

std::string bytes_of(const v1::Envelope& envelope) {
  std::string bytes;
  proto::append_frame(envelope, bytes);
  return bytes;
}

}  // namespace

std::uint64_t Arrivals::latency(double part) const {
  if (latencies_ns.empty()) {
    return 0;
  }
  std::vector<std::uint64_t> sorted = latencies_ns;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return sorted[static_cast<std::size_t>(at)];
}

class Swarm::Reader {
 public:
  Reader(const std::string& socket, std::uint32_t decimation)
      : socket_(client::StreamSocket::connect(client::parse_address(socket),
                                              client::Clock::now() + std::chrono::seconds(10))),
        chunk_(65536) {
    v1::Envelope hello;
    hello.mutable_hello()->set_major(proto::kProtocolMajor);
    hello.mutable_hello()->set_program("load_bench");
    v1::Envelope wish;
    for (const v1::Topic topic : {v1::OBJECTS, v1::HIPS, v1::DEVICES}) {
      wish.mutable_request()->mutable_subscribe()->add_topic(topic);
    }
    wish.mutable_request()->mutable_subscribe()->set_decimation(decimation);
    socket_.send(bytes_of(hello) + bytes_of(wish), client::Clock::now() + std::chrono::seconds(10));
  }

  int descriptor() const noexcept { return socket_.descriptor(); }

  /// What is there now.
  void read(Arrivals& arrivals) {
    std::size_t received = 0;
    if (socket_.receive(chunk_, received, client::Clock::now()) != client::StreamSocket::Outcome::kDone) {
      throw std::runtime_error("the daemon has closed a connection");
    }
    const std::uint64_t now = monotonic_ns();
    arrivals.bytes += received;
    reader_.append(std::string_view(chunk_.data(), received));
    while (const auto message = reader_.next()) {
      envelope_.ParseFromArray(message->data(), static_cast<int>(message->size()));
      if (envelope_.has_frame()) {
        arrivals.latencies_ns.push_back(now - std::min(now, envelope_.frame().monotonic_ns()));
      } else if (envelope_.has_gap()) {
        arrivals.lost += envelope_.gap().last_sequence() - envelope_.gap().first_sequence() + 1;
      }
    }
  }

 private:
  client::StreamSocket socket_;
  proto::FrameReader reader_{proto::kReplyLimit};
  std::vector<char> chunk_;
  v1::Envelope envelope_;
};

Swarm::Swarm(const std::string& socket, std::size_t clients, std::uint32_t decimation, std::size_t stalled)
    : stalled_(stalled) {
  for (std::size_t i = 0; i < clients; ++i) {
    readers_.push_back(std::make_unique<Reader>(socket, decimation));
  }
}

Swarm::~Swarm() = default;

void Swarm::read_for(std::chrono::duration<double> time) {
  // what gathered while the others connected
  const auto settled = client::Clock::now() + std::chrono::milliseconds(300);
  while (client::Clock::now() < settled) {
    wait(std::chrono::milliseconds(10));
  }
  arrivals_ = {};
  const auto end = client::Clock::now() + time;
  while (client::Clock::now() < end) {
    wait(std::chrono::milliseconds(10));
  }
}

void Swarm::wait(std::chrono::milliseconds timeout) {
  std::vector<pollfd> sockets;
  for (std::size_t i = 0; i + stalled_ < readers_.size(); ++i) {
    sockets.push_back({readers_[i]->descriptor(), POLLIN, 0});
  }
  if (::poll(sockets.data(), sockets.size(), static_cast<int>(timeout.count())) <= 0) {
    return;
  }
  for (std::size_t i = 0; i < sockets.size(); ++i) {
    if (sockets[i].revents != 0) {
      readers_[i]->read(arrivals_);
    }
  }
}

void Nuisance::reconnect(std::uint64_t times) {
  thread_ = std::jthread([this, times](const std::stop_token& stop) {
    while (!stop.stop_requested() && deeds_ < times) {
      test::RawClient client(socket_);
      client.say_hello();
      deeds_ += client.receive() ? 1U : 0U;
    }
  });
}

void Nuisance::flood() {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    const ipc::SessionLimits limits;
    test::RawClient client(socket_);
    client.say_hello();
    const auto start = client::Clock::now();
    double sent = 0.0;
    std::size_t open = 0;
    while (!stop.stop_requested() && !is_cut_off_) {
      const double seconds = std::chrono::duration<double>(client::Clock::now() - start).count();
      while (open < limits.open_requests && sent < seconds * limits.requests_per_second) {
        // goes all the way to the servo thread, which has nothing to do; to disarm would be free of limits
        client.request([](v1::Request& request) { request.mutable_resume(); });
        ++open;
        ++sent;
      }
      const auto message = client.receive(std::chrono::milliseconds(1));
      is_cut_off_ = client.is_closed();
      if (message && message->has_response()) {
        --open;
        deeds_ += message->response().error().code() == v1::Error::BUSY ? 0U : 1U;
      }
    }
  });
}

std::uint64_t Nuisance::stop() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  if (is_cut_off_) {
    throw std::runtime_error("the daemon has cut off the flood");
  }
  return deeds_;
}

}  // namespace haptic::bench
