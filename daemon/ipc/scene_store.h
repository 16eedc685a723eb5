#pragma once
// The scene that runs, as clients are told of it, and the way of a new one:
//
//     load() -> building on a thread of its own -> swap command -> servo thread -> answer -> current()
//
// One at a time. io thread, which never waits for the building.

#include <functional>
#include <future>
#include <optional>

#include "ipc/reply.h"
#include "ipc/services.h"
#include "ipc/servo_link.h"

namespace haptic::ipc {

class SceneStore {
 public:
  SceneStore(Services& services, ServoLink& servo);

  const v1::SceneDescription& current() const noexcept { return current_; }

  /// Replies when the scene runs, or why it does not.
  void load(const v1::LoadScene& request, Reply reply);

  /// Goes on when the building is done. To be called every few milliseconds.
  void poll(SteadyClock::time_point now);

  /// The servo thread has answered the swap.
  void swapped(bool done);

 private:
  void swap(BuiltScene built, SteadyClock::time_point now);

  Services& services_;
  ServoLink& servo_;
  v1::SceneDescription current_;
  std::uint64_t last_revision_;
  std::optional<Reply> reply_;  // of the load at hand
  std::future<BuiltScene> building_;
  std::optional<v1::SceneDescription> next_;  // waits for the servo thread's answer
};

}  // namespace haptic::ipc
