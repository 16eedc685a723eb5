#pragma once
// Whoever has come in by a WebSocket. io thread.

#include <functional>

namespace haptic::gateway {

class Session {
 public:
  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  virtual ~Session() = default;

  /// `on_end` is called once, when it is over.
  virtual void start(std::function<void()> on_end) = 0;
  /// Says that the gateway goes, and ends.
  virtual void leave() = 0;
};

}  // namespace haptic::gateway
