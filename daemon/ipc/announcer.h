#pragma once
// What every client is told without asking, and what the log says of it: made from the servo thread's events.
// Missed ticks are told at most once a second, however many there are. io thread.

#include <functional>
#include <string>
#include <vector>

#include "ipc/services.h"
#include "ipc/servo_link.h"

namespace haptic::ipc {

class Announcer {
 public:
  using Broadcast = std::function<void(const v1::Event&)>;

  Announcer(const std::vector<v1::DeviceDescription>& devices, Broadcast broadcast);

  /// An event of the servo thread. `scene` is the one that runs after it.
  void announce(const servo::Event& event, const v1::SceneDescription& scene, SteadyClock::time_point now);

  /// Something that the io thread has seen by itself.
  void announce(v1::Event event, std::uint64_t tick);

  /// Tells of missed ticks that were held back.
  void poll(SteadyClock::time_point now);

  /// Everybody, and the log.
  void tell(const v1::Event& event);

 private:
  const std::vector<v1::DeviceDescription>& devices_;
  Broadcast broadcast_;
  std::uint64_t missed_ = 0;  // not yet told
  std::uint64_t missed_tick_ = 0;
  SteadyClock::time_point next_missed_{};
};

}  // namespace haptic::ipc
