#pragma once
// One viewer of Foxglove's kind: Foxglove itself, Lichtblick, or a program with their client library. io
// thread.

#include <functional>
#include <memory>
#include <string>

#include "client/view/foxglove_feed.h"
#include "client/view/session.h"
#include "client/view/web_socket.h"

namespace haptic::gateway {

class FoxgloveSession final : public Session,
                              public FoxgloveFeed::Listener,
                              public std::enable_shared_from_this<FoxgloveSession> {
 public:
  /// `run`: what tells viewers that a server is still the one that they knew.
  FoxgloveSession(std::shared_ptr<WebSocket> socket, FoxgloveFeed& feed, std::string run);
  ~FoxgloveSession() override;

  void start(std::function<void()> on_end) override;
  void leave() override;

  FoxgloveViewer& viewer() noexcept override { return viewer_; }
  void flush() override;

 private:
  void read();
  void end();

  std::shared_ptr<WebSocket> socket_;
  FoxgloveFeed& feed_;
  std::string run_;
  FoxgloveViewer viewer_;
  std::function<void()> on_end_;
  bool writing_ = false;
  bool is_listening_ = false;
};

}  // namespace haptic::gateway
