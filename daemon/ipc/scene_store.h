#pragma once
// The scene that runs, as clients are told of it, and the way of a new one:
//
//     load(), edit() -> building on a thread of its own -> swap command -> servo thread -> answer ->
//     current()
//
// One at a time. io thread, which never waits for the building.

#include <functional>
#include <future>
#include <memory>
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

  /// The same for the scene that runs, edited. Refused as BUSY if the edit is for another revision than that.
  void edit(const v1::EditScene& request, Reply reply);

  /// Goes on when the building is done. To be called every few milliseconds.
  void poll(SteadyClock::time_point now);

  /// The servo thread has answered the swap.
  void swapped(bool done);

 private:
  bool is_busy(const Reply& reply) const;
  void build(std::function<BuiltScene()> make, Reply reply);
  void swap(BuiltScene built, SteadyClock::time_point now);

  Services& services_;
  ServoLink& servo_;
  v1::SceneDescription current_;
  std::shared_ptr<const engine::Scene> running_;  // what was built of it
  std::uint64_t last_revision_;
  std::optional<Reply> reply_;  // of the load or edit at hand
  std::future<BuiltScene> building_;
  std::optional<v1::SceneDescription> next_;  // waits for the servo thread's answer
  std::shared_ptr<const engine::Scene> next_running_;
};

}  // namespace haptic::ipc
