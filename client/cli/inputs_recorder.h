#pragma once
// The part of a recording that makes it replayable: the inputs of every tick, the state before the first of
// them, and each scene as it can be built without files.

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "client/lib/connection.h"
#include "proto/recording/session.h"

namespace haptic::cli {

class InputsRecorder {
 public:
  /// Both outlive this.
  InputsRecorder(client::Connection& daemon, recording::SessionWriter& writer)
      : daemon_(daemon), writer_(writer) {}

  /// Subscribes, and asks for the state. Throws client::Error: Unsupported of a daemon that is too old,
  /// Invalid if scene or state are larger than an answer may be.
  void begin();

  /// Writes what belongs to its subscription; false: it does not. After a gap it asks for the state again, so
  /// that a replay can go on from there. Throws as begin() does, and what the writer throws.
  bool take(const v1::Envelope& message);

  /// Writes the scene of this revision, with its meshes, unless that has been done.
  void write_scene(std::uint64_t revision, std::uint64_t time_ns);

  void end();

  std::uint64_t lost() const noexcept { return lost_; }  // ticks

 private:
  void ask_for_state();
  void write(const v1::Frame& frame);

  client::Connection& daemon_;
  recording::SessionWriter& writer_;
  std::uint32_t subscription_ = 0;
  std::optional<v1::WorldState> state_;  // not yet written
  std::set<std::uint64_t> scenes_;       // that are written
  std::uint64_t time_ = 0;               // of the newest frame, ns
  std::uint64_t lost_ = 0;
};

}  // namespace haptic::cli
