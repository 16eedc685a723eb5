#pragma once
// Runs a recording again, through the very tick of the service, and compares the hash of the state after each
// tick with the one that was recorded:
//
//     scene, state after tick 99, inputs of tick 100, inputs of tick 101, ...
//
// What is recorded is not trusted: whatever comes, it is replayed or refused. Offline; not real-time safe.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"
#include "replay/recorded_device.h"
#include "servo/servo_loop.h"

namespace haptic::load {
struct LoadedScene;
}

namespace haptic::replay {

/// The first tick after which the state is another than the recorded one.
struct Difference {
  std::uint64_t tick = 0;
  std::uint64_t scene_revision = 0;
  std::uint64_t recorded = 0;  // hashes
  std::uint64_t replayed = 0;
  std::string where;  // as far as the frame tells, e.g. "object box: position.x is 0.5, recorded 0.25"
};

/// Ticks whose inputs the recording does not have; it can be replayed again only from the next state on.
struct Gap {
  std::uint64_t first_tick = 0;
  std::uint64_t last_tick = 0;
};

/// What has been replayed so far.
struct Report {
  std::uint64_t ticks = 0;        // that were run again
  std::uint64_t compared = 0;     // of these, those that have a hash
  std::uint64_t unreachable = 0;  // after a gap, and before the next state
  std::uint64_t starts = 0;       // states from which it began
  std::uint64_t first_tick = 0;   // that was run again
  std::uint64_t last_tick = 0;
  std::vector<Gap> gaps;
  std::optional<Difference> difference;
};

class Replayer {
 public:
  Replayer();
  ~Replayer();
  Replayer(const Replayer&) = delete;
  Replayer& operator=(const Replayer&) = delete;

  /// A scene that runs at the start or after a SCENE command of the inputs that follow.
  void add_scene(v1::SceneDescription scene);

  /// Goes on from this state. One that is of the tick just replayed is compared with it instead. Throws
  /// load::LoadError if its scene has not been added or cannot be built, or the state is not of it.
  void take(const v1::WorldState& state);

  /// Runs the tick of a frame that has inputs, unless there was no state yet, it lies before the state, or a
  /// gap before it. Nothing is run after the first difference. Throws load::LoadError if the inputs do not
  /// fit the devices or the scene.
  void take(const v1::Frame& frame);

  const Report& report() const noexcept { return report_; }

 private:
  void check(const v1::InputsFrame& inputs) const;
  void feed(const v1::InputsFrame& inputs);
  void send(const v1::InputsFrame::Command& command);
  std::unique_ptr<servo::PreparedScene> build(std::uint64_t revision);
  void answer() const;
  void compare(std::uint64_t recorded, std::uint64_t replayed, const v1::Frame& frame);

  std::map<std::uint64_t, v1::SceneDescription> scenes_;  // by revision
  std::shared_ptr<const load::LoadedScene> loaded_;       // the scene that was built last
  std::vector<std::unique_ptr<RecordedDevice>> devices_;
  std::vector<std::string> names_;           // of the devices
  std::unique_ptr<servo::Mailbox> mailbox_;  // outlives the loop
  std::unique_ptr<servo::ServoLoop> loop_;   // none: no state yet, or a gap after it
  std::uint64_t tick_ = 0;                   // the last one that was replayed
  Report report_;
};

}  // namespace haptic::replay
