#pragma once
// A device that is where a client says: what the client tells comes in on the io thread, the force goes back
// the same way, and neither side waits for the other.
//
//     client --> io thread  --place()-->           --read()-->   servo thread
//            <--            <--live_force()--      <--write()--
//
// A pose that is not told again grows old in the servo's eyes, like that of any device.

#include <string>

#include "drivers/device.h"
#include "drivers/device_link.h"
#include "drivers/velocity_estimate.h"

namespace haptic::drivers {

/// Poses come when a network and two schedulers let them: a pair that comes together tells no velocity (s).
inline constexpr double kVelocityLag = 0.02;

class VirtualDevice final : public Device {
 public:
  explicit VirtualDevice(std::string name);

  // io thread

  /// Where it is now, in the world; `sample.time` is of the servo's clock, not in future, and does not
  /// descend. Unless `tells_velocity` its velocity is as the positions tell, smoothed by kVelocityLag.
  void place(DeviceSample sample, bool tells_velocity) noexcept;

  /// What the servo wants of it now; zero, with expiry 0, if nothing is alive.
  ForceCommand live_force(Nanoseconds now) noexcept { return link_.live_force(now); }

  // servo thread, and its owner

  const DeviceInfo& info() const noexcept override { return info_; }
  void start() override {}
  void stop() noexcept override {}
  /// False until it was placed for the first time.
  bool read(Nanoseconds now, DeviceSample& sample) noexcept override;
  void write(Nanoseconds now, const ForceCommand& command) noexcept override;

 private:
  DeviceInfo info_;
  DeviceLink link_;
  VelocityEstimate velocity_;  // io thread's
};

}  // namespace haptic::drivers
