#pragma once
// The scene that runs, as clients are told of it, and the way of a new one:
//
//     load(), edit() -> building on a thread of its own -> swap command -> servo thread -> answer ->
//     current()
//
// One at a time. io thread, which never waits for the building.

#include <deque>
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

  /// The scene that runs, as it was built.
  const engine::Scene& running() const noexcept { return *running_; }
  const std::shared_ptr<const engine::Scene>& shared_running() const noexcept { return running_; }

  /// Answers with a scene that runs or has run and is still kept; `most_bytes` is how large the answer may
  /// be.
  void describe(const v1::GetScene& request, std::size_t most_bytes, const Reply& reply) const;

  /// Replies when the scene runs, or why it does not.
  void load(const v1::LoadScene& request, Reply reply);

  /// The same for the scene that runs, edited. Refused as BUSY if the edit is for another revision than that.
  void edit(const v1::EditScene& request, Reply reply);

  /// Goes on when the building is done. To be called every few milliseconds.
  void poll(SteadyClock::time_point now);

  /// The servo thread has answered the swap.
  void swapped(bool done);

  /// Whether somebody may still ask for scenes that have run.
  void keep_scenes(bool keep);

 private:
  struct Kept {
    v1::SceneDescription description;
    std::shared_ptr<const engine::Scene> scene;
  };

  bool is_busy(const Reply& reply) const;
  void build(std::function<BuiltScene()> make, Reply reply);
  void swap(BuiltScene built, SteadyClock::time_point now);

  Services& services_;
  ServoLink& servo_;
  v1::SceneDescription current_;
  std::shared_ptr<const engine::Scene> running_;  // what was built of it
  bool keeps_scenes_ = false;
  std::deque<Kept> before_;  // scenes that have run, the newest first; only while they are kept
  std::uint64_t last_revision_;
  std::optional<Reply> reply_;  // of the load or edit at hand
  std::future<BuiltScene> building_;
  std::optional<v1::SceneDescription> next_;  // waits for the servo thread's answer
  std::shared_ptr<const engine::Scene> next_running_;
};

}  // namespace haptic::ipc
