#include "tests/bench/nats_swarm.h"

#include <sys/epoll.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

namespace haptic::bench {
namespace {

std::uint64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000U + static_cast<std::uint64_t>(now.tv_nsec);
}

// the length of the payload stands last in "MSG <subject> <sid> [reply] <bytes>"
std::size_t payload_of(std::string_view line) {
  const std::string_view number = line.substr(line.rfind(' ') + 1);
  std::size_t size = 0;
  std::from_chars(number.data(), number.data() + number.size(), size);
  return size;
}

}  // namespace

class NatsSwarm::Subscriber {
 public:
  Subscriber(const std::string& server, const std::string& subject)
      : socket_(client::StreamSocket::connect(client::parse_address(server),
                                              client::Clock::now() + std::chrono::seconds(10))) {
    socket_.send("CONNECT {\"verbose\":false,\"pedantic\":false}\r\nSUB " + subject + " 1\r\nPING\r\n",
                 client::Clock::now() + std::chrono::seconds(10));
  }

  int descriptor() const noexcept { return socket_.descriptor(); }
  bool is_ready() const noexcept { return is_ready_; }

  /// What is there now. False if the server has closed.
  bool read(Arrivals& arrivals) {
    static std::array<char, 262'144> chunk;
    std::size_t received = 0;
    if (socket_.receive(chunk, received, client::Clock::now()) != client::StreamSocket::Outcome::kDone) {
      return false;
    }
    arrivals.bytes += received;
    buffer_.append(chunk.data(), received);
    std::size_t read = 0;
    while (take(arrivals, read)) {
    }
    buffer_.erase(0, read);
    return true;
  }

 private:
  // one line, with its payload
  bool take(Arrivals& arrivals, std::size_t& read) {
    const std::size_t end = buffer_.find("\r\n", read);
    if (end == std::string::npos) {
      return false;
    }
    const std::string_view line = std::string_view(buffer_).substr(read, end - read);
    if (line.starts_with("MSG ")) {
      const std::size_t size = payload_of(line);
      if (buffer_.size() < end + 2 + size + 2) {
        return false;
      }
      count(std::string_view(buffer_).substr(end + 2, size), arrivals);
      read = end + 2 + size + 2;
      return true;
    }
    if (line == "PONG") {
      is_ready_ = true;
    } else if (line == "PING") {
      socket_.send("PONG\r\n", client::Clock::now() + std::chrono::seconds(1));
    }
    read = end + 2;
    return true;
  }

  void count(std::string_view payload, Arrivals& arrivals) {
    if (!frame_.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) {
      throw std::runtime_error("a payload is no Frame");
    }
    const std::uint64_t now = monotonic_ns();
    arrivals.latencies_ns.push_back(now - std::min(now, frame_.monotonic_ns()));
    arrivals.lost += last_ == 0 ? 0 : frame_.sequence() - last_ - 1;
    last_ = frame_.sequence();
  }

  client::StreamSocket socket_;
  std::string buffer_;
  bool is_ready_ = false;
  std::uint64_t last_ = 0;  // sequence; 0: none yet
  v1::Frame frame_;
};

NatsSwarm::NatsSwarm(const std::string& server, std::size_t subscribers, const std::string& subject)
    : poll_(::epoll_create1(EPOLL_CLOEXEC)) {
  subscribers_.reserve(subscribers);
  for (std::size_t i = 0; i < subscribers; ++i) {
    subscribers_.push_back(std::make_unique<Subscriber>(server, subject));
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u64 = i;
    ::epoll_ctl(poll_, EPOLL_CTL_ADD, subscribers_.back()->descriptor(), &event);
  }
  const auto deadline = client::Clock::now() + std::chrono::seconds(60);
  const auto is_ready = [](const std::unique_ptr<Subscriber>& one) { return one->is_ready(); };
  while (!std::all_of(subscribers_.begin(), subscribers_.end(), is_ready)) {
    if (client::Clock::now() > deadline) {
      throw std::runtime_error("the server at " + server + " does not take all subscribers");
    }
    wait(std::chrono::milliseconds(100));
  }
}

NatsSwarm::~NatsSwarm() { ::close(poll_); }

void NatsSwarm::read_for(std::chrono::duration<double> time) {
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

void NatsSwarm::wait(std::chrono::milliseconds timeout) {
  std::array<epoll_event, 256> events{};
  const int count =
      ::epoll_wait(poll_, events.data(), static_cast<int>(events.size()), static_cast<int>(timeout.count()));
  for (int i = 0; i < count; ++i) {
    Subscriber& subscriber = *subscribers_[events[static_cast<std::size_t>(i)].data.u64];
    if (!subscriber.read(arrivals_)) {
      ::epoll_ctl(poll_, EPOLL_CTL_DEL, subscriber.descriptor(), nullptr);
      ++cut_off_;
    }
  }
}

}  // namespace haptic::bench
