#pragma once
// HTTP and WebSockets, with or without TLS, by Boost.Beast: gives files, and hands over the WebSockets that
// are let in. io thread.

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>

#include "client/view/log.h"
#include "client/view/web_settings.h"

namespace haptic::gateway {

class WebServer {
 public:
  /// Listens, but takes nobody yet. Throws std::runtime_error if it cannot, or a file of TLS is wrong.
  WebServer(boost::asio::io_context& io, WebSettings settings, Log& log, OnSocket on_socket);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  void start();
  /// Takes nobody else. WebSockets are their owners'.
  void stop();

  /// "http://127.0.0.1:8765/"
  const std::string& url() const noexcept;

 private:
  class Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace haptic::gateway
