#pragma once
// One connection to the daemon that is read only as fast as somebody asks for messages: what is not fetched
// waits with the daemon, which drops what is no longer new. io thread.
//
//     open() --> on_open --> read() --> on_message --> read() ...      until on_end, or close()

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "client/view/byte_stream.h"
#include "haptic/v1/control.pb.h"
#include "proto/framing.h"
#include "proto/protocol.h"

namespace haptic::gateway {

class DaemonLink : public std::enable_shared_from_this<DaemonLink> {
 public:
  struct Greeting {
    v1::Hello hello;
    double rate_hz = 0.0;  // ticks in a second
  };
  using OnOpen = std::function<void(const Greeting&)>;
  using OnMessage = std::function<void(std::string_view envelope)>;
  using OnSent = std::function<void()>;
  using OnEnd = std::function<void(const std::string& why)>;

  DaemonLink(boost::asio::io_context& io, const DaemonDoor& door);

  /// Connects, says hello and asks for the rate. `on_end` is called once at the most, then nothing else.
  void open(OnOpen on_open, OnEnd on_end);

  /// Asks for one message; it is an Envelope, valid while it is called back. Once at a time, after on_open.
  void read(OnMessage on_message);

  /// Messages go in their order; `on_sent`, if any, when this one is on its way.
  void send(const v1::Envelope& envelope, OnSent on_sent = {});

  /// From now on nothing is called back.
  void close();

 private:
  void greet(std::shared_ptr<ByteStream> stream);
  void take_greeting(std::string_view message, Greeting greeting);
  void deliver();
  void fetch();
  void write();
  void end(const std::string& why);

  boost::asio::io_context& io_;
  const DaemonDoor& door_;
  std::shared_ptr<ByteStream> stream_;
  boost::asio::steady_timer timer_;  // for the greeting
  OnOpen on_open_;
  OnEnd on_end_;
  OnMessage on_message_;  // none: nobody asks
  proto::FrameReader reader_{proto::kReplyLimit};
  std::array<char, 65536> chunk_{};
  bool fetching_ = false;
  bool delivering_ = false;

  struct Outbound {
    std::string bytes;
    OnSent on_sent;
  };
  std::deque<Outbound> outbound_;  // the first is being written
  bool ended_ = false;
};

}  // namespace haptic::gateway
