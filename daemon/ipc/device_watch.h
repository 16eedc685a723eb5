#pragma once
// Tells every client when a device gets somewhere in its life: it looks at the phases some 20 times a second.
// What arming and faults make of a ready device is told by their own events. io thread.

#include <functional>
#include <vector>

#include "ipc/services.h"
#include "ipc/servo_link.h"

namespace haptic::ipc {

/// A device that flickers is told of no more often than this, and then where it is at last.
inline constexpr std::chrono::milliseconds kChangePeriod{250};

class DeviceWatch {
 public:
  /// The tick is filled in by the one who is told.
  using Tell = std::function<void(const v1::Event&)>;

  /// `services` outlives it. What is so at its first look is told as well, unless the device is ready.
  DeviceWatch(const Services& services, Tell tell);

  /// To be called every few milliseconds.
  void poll(SteadyClock::time_point now);

 private:
  struct Seen {
    drivers::DeviceState state{};
    SteadyClock::time_point next{};  // not before
  };

  const Services& services_;
  Tell tell_;
  std::vector<Seen> seen_;
  SteadyClock::time_point next_look_{};
};

}  // namespace haptic::ipc
