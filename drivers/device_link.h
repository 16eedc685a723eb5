#pragma once
// What a driver's own thread and the servo thread share, for hardware that needs I/O: the newest sample one
// way, the newest force the other, neither side ever waiting.
//
//     driver's thread  --publish(sample)-->      --read()-->   servo thread
//                      <--live_force(now)--      <--write()--
//
// A force ends by itself: live_force() is zero from its expiry on, and when it was not refreshed for
// kForceLifetime, whatever expiry it carries. The link also knows where the device stands: the driver's side
// speaks of the device's own frame, the servo's side of the world.

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "drivers/device.h"
#include "drivers/device_life.h"
#include "rt/triple_buffer.h"

namespace haptic::drivers {

/// Where the frame of a device stands.
struct BasePose {
  glm::dvec3 position{0.0, 0.0, 0.0};          // of its origin in the world, m
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // world_from_base, unit
};

/// A force that the servo has not renewed for so long is zero: three ticks of 1 kHz.
inline constexpr Nanoseconds kForceLifetime = 3'000'000;

class DeviceLink {
 public:
  /// `life`, if given, becomes ready with each sample that is published.
  explicit DeviceLink(const BasePose& world_from_base = {}, DeviceLife* life = nullptr)
      : world_from_base_(world_from_base), life_(life) {}

  // Servo thread; real-time safe.

  /// The newest sample, in the world. False if there is none, or none that counts (publish_nothing()).
  bool read(DeviceSample& sample) noexcept;

  /// A force in the world.
  void write(Nanoseconds now, const ForceCommand& command) noexcept;

  // Driver's thread; real-time safe.

  /// A sample in the device's own frame.
  void publish(const DeviceSample& sample) noexcept;

  /// There is no sample any more: the device is gone, or what it tells does not count.
  void publish_nothing() noexcept;

  /// What to do to the hand at `now`, in the device's own frame: zero unless a command is alive. Never holds
  /// a number that is not finite.
  ForceCommand live_force(Nanoseconds now) noexcept;

 private:
  struct Measured {
    DeviceSample sample;
    bool counts = false;
  };
  struct Commanded {
    ForceCommand command;
    Nanoseconds written = 0;
  };

  BasePose world_from_base_;
  DeviceLife* life_;
  rt::TripleBuffer<Measured> measured_;
  rt::TripleBuffer<Commanded> commanded_;
};

}  // namespace haptic::drivers
