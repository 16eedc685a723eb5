#pragma once
// The daemon's numbers for Prometheus over HTTP, on the loopback interface only: GET /metrics, and nothing
// else. One answer for each connection. What comes is bounded in size and in time, and a few connections are
// served at once. io thread.

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace haptic::ipc {

struct MetricsSettings {
  std::uint32_t port = 0;  // 0: one that is free
  std::size_t connections = 4;
  std::size_t request_bytes = 8192;
  std::chrono::milliseconds patience{5000};  // for the request, and as much for the answer
};

class MetricsServer {
 public:
  /// Opens the sockets, on 127.0.0.1 and, if the machine has it, ::1. `page` makes the answer. Throws
  /// ListenError.
  MetricsServer(boost::asio::io_context& io, const MetricsSettings& settings,
                std::function<std::string()> page);
  ~MetricsServer();
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;

  void start();

  /// Ends all connections, and takes no more.
  void stop();

  /// "http://127.0.0.1:9464/metrics", for a log.
  const std::vector<std::string>& addresses() const noexcept;

 private:
  class Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace haptic::ipc
