#pragma once
// haptic-view as a whole: lets browsers and viewers in, and shows them what the daemon tells its observers.
// One thread.

#include <functional>
#include <memory>
#include <string>

#include "client/lib/tls.h"
#include "client/view/web_server.h"

namespace haptic::gateway {

struct Options {
  std::string daemon;         // its address; see client::parse_address()
  client::Identity identity;  // for TLS with it
  WebSettings web;
  double frames_per_second = 60.0;  // the most that each page and viewer gets
};

class Gateway {
 public:
  /// Listens. Throws std::runtime_error if it cannot. `log` takes a line for a person.
  Gateway(Options options, std::function<void(const std::string&)> log);
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  /// Serves until stop().
  void run();

  /// Says goodbye to everybody, for two seconds at the most. Safe from any thread.
  void stop();

  /// SIGTERM and SIGINT do what stop() does.
  void stop_on_signals();

  /// "http://127.0.0.1:8765/"
  const std::string& url() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptic::gateway
