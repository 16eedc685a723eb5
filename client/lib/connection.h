#pragma once
// A client's connection to the daemon: hello, calls that wait for their answer, and what the daemon sends on
// its own. Blocking, with a time limit for everything; one thread at a time.
//
//     Connection daemon({.program = "example"});
//     daemon.subscribe({v1::OBJECTS}, 10);
//     while (auto message = daemon.receive(std::chrono::seconds(1))) { ... message->frame() ... }

#include <chrono>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "client/lib/stream_socket.h"
#include "client/lib/tls.h"
#include "haptic/v1/control.pb.h"
#include "proto/framing.h"
#include "proto/protocol.h"

namespace haptic::client {

struct Options {
  std::string address;  // see parse_address(); empty: the default place
  Identity identity;    // for TLS over TCP; empty: none, and the daemon lets observe only
  std::string program = "client";
  std::string version = HAPTIC_VERSION;
  std::chrono::milliseconds timeout{10'000};  // for connecting with Hello, and for the answer of each call
  std::uint32_t major = proto::kProtocolMajor;
};

class Connection {
 public:
  /// Connects and exchanges Hello. Throws Unreachable, ProtocolMismatch or Refused.
  explicit Connection(const Options& options);

  /// What the daemon said in its Hello.
  const v1::Hello& daemon() const noexcept { return daemon_; }

  /// Sends the request and waits for its response; the id is chosen here. Throws what the daemon answered
  /// (error.h), or Unreachable. Frames and events that arrive meanwhile are kept for receive().
  v1::Response call(v1::Request request);

  /// Returns the number of the subscription. One frame for `decimation` ticks.
  std::uint32_t subscribe(const std::vector<v1::Topic>& topics, std::uint32_t decimation);
  /// With all that can be chosen. Throws NotFound for a finger or an object that is not there.
  std::uint32_t subscribe(v1::Subscribe subscription);

  /// Ends a subscription; what of it has arrived already is dropped, but a frame on its way may still come.
  void unsubscribe(std::uint32_t subscription);

  /// Takes the drive lease; `silence` is the longest between two heartbeats, 0: as long as the config
  /// permits. Returns what was agreed. From then on call() and receive() send the heartbeats while they wait,
  /// so that no more than this time may pass between them; where the lease is lost all the same, they throw
  /// Error. Throws Refused if another client holds it.
  std::chrono::milliseconds acquire_drive(std::chrono::milliseconds silence = {});
  /// Nothing if it is not held.
  void release_drive();
  bool holds_drive() const noexcept { return beat_every_.has_value(); }

  /// The time for the answer of each call from now on.
  void set_timeout(std::chrono::milliseconds timeout) noexcept { timeout_ = timeout; }

  /// The next frame, event or gap; frames of a batch come one by one. Nothing if none came in time, or a
  /// signal arrived. Throws Unreachable when the daemon is gone, or why it cut this client off.
  std::optional<v1::Envelope> receive(std::chrono::milliseconds timeout);

 private:
  void greet(const Options& options, Clock::time_point deadline);
  void send(const v1::Envelope& envelope, Clock::time_point deadline);
  StreamSocket::Outcome receive_some(std::size_t& received, Clock::time_point deadline);
  std::optional<v1::Envelope> read(Clock::time_point deadline, bool until_signal);
  void keep(v1::Envelope message);
  void beat_if_due();
  void take_beat(const v1::Response& response);
  [[noreturn]] void throw_gone();

  std::string name_;
  std::chrono::milliseconds timeout_;
  StreamSocket socket_;
  std::optional<Tls> tls_;
  proto::FrameReader reader_{proto::kReplyLimit};
  std::vector<char> chunk_;
  v1::Hello daemon_;
  std::uint64_t last_request_ = 0;
  std::deque<v1::Envelope> kept_;                        // arrived and not yet received
  std::optional<std::chrono::milliseconds> beat_every_;  // while it holds the drive lease
  Clock::time_point next_beat_;
};

}  // namespace haptic::client
