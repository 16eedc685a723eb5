#pragma once
// What a web server is told, and what its parts share.

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "client/view/admission.h"
#include "client/view/log.h"
#include "client/view/web_socket.h"

namespace haptic::gateway {

struct WebSettings {
  std::string address = "127.0.0.1";
  unsigned short port = 8765;  // 0: any
  std::string certificate;     // PEM files; empty: without TLS
  std::string key;
  std::filesystem::path page;
  HouseRules rules;
  std::size_t sockets = 16;                            // WebSockets at once
  std::size_t connections = 128;                       // of all kinds at once
  std::size_t message_bytes = std::size_t{64} * 1024;  // the longest message of a client
  std::size_t unsent_bytes = std::size_t{256} * 1024;  // in the system, for a client that does not read
  std::chrono::seconds request{10};                    // for TLS, and for a request to come
  std::chrono::seconds answer{120};                    // for a browser to take a file
  std::chrono::seconds idle{60};                       // without a sign of life of a WebSocket
  std::chrono::milliseconds goodbye{2'000};            // for a client to take why its WebSocket is closed
};

using OnSocket = std::function<void(std::shared_ptr<WebSocket>, const Admission&)>;

/// Whoever holds one is counted.
using Seat = std::shared_ptr<int>;

/// How many are taken, apart from `seats` itself.
inline std::size_t taken(const Seat& seats) { return static_cast<std::size_t>(seats.use_count()) - 1; }

struct WebShared {
  WebSettings settings;
  Log& log;
  OnSocket on_socket;
  Seat connections = std::make_shared<int>();
  Seat sockets = std::make_shared<int>();
  bool stopped = false;
};

}  // namespace haptic::gateway
