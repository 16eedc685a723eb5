#pragma once
// A device without hardware that forces really move: a mass m with damping d, held by a hand, which is a
// spring k and a damper b to a point h(t) on a path.
//
//      force F ->  [ m ]--/\/\/\/\--+
//                  [   ]---[ b ]----h(t)        m a = F + k (h - x) + b (h' - v) - d v
//                  ~~~d~~~
//
// Orientation is that of the path; torque moves nothing. Computed in read(), without a thread, on the servo's
// clock alone: equal times and forces give equal bits. Real-time safe. What it tells can be made to fail on
// purpose (injected_fault.h); the mass moves on as it would.

#include <string>
#include <vector>

#include "drivers/device.h"
#include "drivers/path.h"
#include "drivers/simulated/injected_fault.h"

namespace haptic::drivers {

struct SimulatedSettings {
  std::string name;
  double mass = 0.1;              // kg, > 0
  double damping = 0.0;           // N s/m, >= 0
  double hand_stiffness = 0.0;    // N/m, >= 0
  double hand_damping = 0.0;      // N s/m, >= 0
  std::vector<PathPoint> path{};  // of the hand
  bool repeat = false;
  std::vector<InjectedFault> faults{};
};

class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(SimulatedSettings settings);

  const DeviceInfo& info() const noexcept override { return info_; }

  /// The mass rests where the path begins, from the first read() on, which is time 0 of the path.
  void start() override;
  void stop() noexcept override;

  /// Moves the mass on to `now` under the force that write() gave, which counts as zero from its expiry on.
  /// Of a gap of more than kLongestGap only the end is computed.
  bool read(Nanoseconds now, DeviceSample& sample) noexcept override;
  void write(Nanoseconds now, const ForceCommand& command) noexcept override;

 private:
  void advance(Nanoseconds to) noexcept;
  void step(Nanoseconds from, double dt) noexcept;

  DeviceInfo info_;
  SimulatedSettings settings_;
  FaultInjector faults_;
  bool running_ = false;
  bool timed_ = false;  // start_time_ is set
  Nanoseconds start_time_ = 0;
  Nanoseconds time_ = 0;  // of position_ and velocity_
  glm::dvec3 position_{0.0};
  glm::dvec3 velocity_{0.0};
  ForceCommand command_;
};

}  // namespace haptic::drivers
