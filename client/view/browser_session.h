#pragma once
// One page of ours: a WebSocket that speaks haptic.v1, and a connection to the daemon of its own, so that the
// daemon's own limits, leases and policies hold for each page alone. Each message is an Envelope; the gateway
// says hello first, then the page asks.
//
//     page -- requests --> policy --> daemon
//      ^  <-- refusals ------+          |
//      +------ everything else <--------+    one message at a time: what a slow page does not take is not
//                                            fetched from the daemon, which replaces it by what is newer
//
// io thread.

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "client/view/admission.h"
#include "client/view/daemon_link.h"
#include "client/view/log.h"
#include "client/view/session.h"
#include "client/view/web_socket.h"

namespace haptic::gateway {

class BrowserSession final : public Session, public std::enable_shared_from_this<BrowserSession> {
 public:
  BrowserSession(std::shared_ptr<WebSocket> socket, Rights rights, std::shared_ptr<DaemonLink> link,
                 double frames_per_second, Log& log);

  void start(std::function<void()> on_end) override;
  void leave() override;

 private:
  struct Pending {
    Outgoing message;
    std::function<void()> on_written;
  };

  void greet(const DaemonLink::Greeting& greeting);
  void read_daemon();
  void read_page();
  void take_request(std::string_view message);
  void refuse(const v1::Request& request, const v1::Error& error);
  void send(std::string envelope, std::function<void()> on_written);
  void write();
  void end();

  std::shared_ptr<WebSocket> socket_;
  Rights rights_;
  std::shared_ptr<DaemonLink> link_;
  double frames_per_second_;
  Log& log_;
  std::function<void()> on_end_;
  std::uint32_t least_decimation_ = 1;
  std::deque<Pending> pending_;  // the first is being written; one of the daemon and one of ours at the most
  bool ended_ = false;
};

}  // namespace haptic::gateway
