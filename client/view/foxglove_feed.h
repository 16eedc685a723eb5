#pragma once
// What all viewers of Foxglove's kind see: one connection to the daemon as an observer, for as long as any of
// them is there, drawn once for all. It comes back by itself when the daemon does. io thread.

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <string>
#include <vector>

#include "client/lib/backoff.h"
#include "client/view/daemon_link.h"
#include "client/view/foxglove_viewer.h"
#include "client/view/log.h"

namespace haptic::gateway {

class FoxgloveFeed {
 public:
  /// Whoever is told what there is to see.
  class Listener {
   public:
    Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    virtual ~Listener() = default;
    virtual FoxgloveViewer& viewer() noexcept = 0;
    /// Something waits in the viewer.
    virtual void flush() = 0;
  };

  FoxgloveFeed(boost::asio::io_context& io, const DaemonDoor& door, double frames_per_second, Log& log);
  ~FoxgloveFeed();
  FoxgloveFeed(const FoxgloveFeed&) = delete;
  FoxgloveFeed& operator=(const FoxgloveFeed&) = delete;

  void add(Listener& listener);
  void remove(Listener& listener);

  /// Gives a viewer that has just subscribed to the scene its shapes.
  void catch_up(FoxgloveViewer& viewer) const;

 private:
  void connect();
  void disconnect();
  void opened(const DaemonLink::Greeting& greeting);
  void lost(const std::string& why);
  void read();
  void take(const v1::Envelope& envelope);
  void take_response(const v1::Response& response);
  void take_frame(const v1::Frame& frame);
  void take_event(const v1::Event& event);
  void ask_scene(bool with_meshes);
  bool wants(Topic topic) const;
  void set(Slot slot, std::string message, std::uint64_t time_ns);
  void flush();

  boost::asio::io_context& io_;
  const DaemonDoor& door_;
  double frames_per_second_;
  Log& log_;
  boost::asio::steady_timer timer_;  // until the next try
  client::Backoff backoff_;
  std::shared_ptr<DaemonLink> link_;
  std::vector<Listener*> listeners_;
  std::string problem_;  // why there is no daemon; empty: there is one, or nobody has tried yet
  v1::SceneDescription scene_;
  std::vector<std::string> devices_;
  Payload shapes_;
  std::uint64_t shapes_time_ns_ = 0;
  bool asks_scene_ = false;
};

}  // namespace haptic::gateway
