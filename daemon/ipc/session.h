#pragma once
// One client, from its hello to its end. Reads requests, writes what its outbox holds, and never waits for
// the client: what a slow one does not fetch is dropped or ends it (outbox.h). io thread.
//
//     connected -- hello --> serving -- error, overflow, stop --> leaving (goodbye, then the end)

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "ipc/dispatch.h"
#include "ipc/outbox.h"
#include "ipc/peer.h"
#include "ipc/request_rate.h"
#include "ipc/session_limits.h"
#include "ipc/stream.h"
#include "proto/framing.h"

namespace haptic::ipc {

class Session : public std::enable_shared_from_this<Session> {
 public:
  using OnEnd = std::function<void(ClientId)>;

  Session(ClientId id, std::shared_ptr<Stream> stream, Peer peer, const SessionLimits& limits, Desk& desk,
          OnEnd on_end);

  void start();

  /// An event for every client; one that has not said hello gets nothing.
  void tell(const std::string& framed_event);

  /// Says goodbye with the error, and ends.
  void cut_off(const v1::Error& error);

  bool is_serving() const noexcept { return state_ == State::kServing; }
  const std::string& user() const noexcept { return peer_.user; }

 private:
  enum class State { kConnected, kServing, kLeaving, kEnded };

  void read();
  void take_bytes(std::size_t size);
  void take_message(std::string_view bytes);
  void take_hello(const v1::Envelope& envelope);
  void take_request(const v1::Request& request);
  bool is_within_limits(const v1::Request& request, const Reply& reply);
  v1::Envelope hello() const;

  void push_control(const v1::Envelope& envelope);
  void write();
  void end();

  ClientId id_;
  std::shared_ptr<Stream> stream_;
  Peer peer_;
  SessionLimits limits_;
  Desk& desk_;
  OnEnd on_end_;
  State state_ = State::kConnected;
  boost::asio::steady_timer timer_;  // for hello, then for goodbye
  proto::FrameReader reader_;
  std::array<char, 16384> chunk_;
  Outbox outbox_;
  std::vector<Piece> writing_;  // empty: no write is under way
  std::size_t open_requests_ = 0;
  RequestRate rate_;
  Caller caller_;
};

}  // namespace haptic::ipc
