#pragma once
// The last stage before the device, always on: whatever the engine, a scene or a client asks for, what leaves
// here is finite, bounded in magnitude and in rate, and zero unless armed and free of faults. Servo thread;
// real-time safe.
//
//   wanted force -> finite? -> ramp after arming -> magnitude -> slew -> device
//                    | no, or over-speed, stale sample, missed ticks
//                    +-> zero in this very tick, and a latched named fault
//
// A fault cuts: nothing is known any more of what the force should be. Disarming, a force that the engine
// stops giving, and a fault of those who drive rather than of what is measured, go to zero by the slew limit
// instead (10 ms at the defaults), so that the hand is not kicked.

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "safety/fault.h"

namespace haptic::safety {

struct GuardLimits {
  double max_force = 5.0;         // N, magnitude
  double max_force_rate = 500.0;  // N/s, magnitude of the change
  double max_speed = 2.0;         // m/s of the device
  double arm_ramp = 0.5;          // s from none of the force to all of it
  double max_sample_age = 0.02;   // s
};

/// Which limits acted in the last tick.
enum Limit : std::uint32_t { kLimitNone = 0, kLimitForce = 1, kLimitRate = 2, kLimitRamp = 4 };

/// What the guard must know of one device in one tick.
struct GuardInput {
  std::uint64_t tick = 0;
  std::uint32_t device = 0;  // index, for the fault
  bool present = false;      // there is a sample
  double sample_age = 0.0;   // s
  glm::dvec3 position{0.0};  // m
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 velocity{0.0};  // m/s
  glm::dvec3 force{0.0};     // N wanted
  glm::dvec3 torque{0.0};    // N m wanted
};

struct GuardOutput {
  glm::dvec3 force{0.0};
  glm::dvec3 torque{0.0};
  std::uint32_t limits = kLimitNone;
};

/// The guard of one device.
class ForceGuard {
 public:
  explicit ForceGuard(const GuardLimits& limits) noexcept : limits_(limits) {}

  /// Lets force through from now on, ramping up. Refused (false) while a fault is latched.
  bool arm() noexcept;
  /// Armed and fully ramped at once: for `simulate`, where no hand is near.
  void arm_at_once() noexcept;
  /// Wants no force from now on; what there is goes down by the slew limit.
  void disarm() noexcept;
  /// Ramps up again from none, as after arm(). For when another scene takes over.
  void restart_ramp() noexcept { ramp_ = 0.0; }
  bool armed() const noexcept { return armed_; }

  /// Latches a fault from outside (missed ticks, another device). The first one is kept.
  void latch(const Fault& fault) noexcept;
  /// The same, but force goes down by the slew limit. A fault that comes meanwhile cuts all the same.
  void latch_gently(const Fault& fault) noexcept;
  /// A fault has cut force, and it is zero.
  bool is_cut() const noexcept { return cut_; }
  /// Forgets the fault; stays disarmed.
  void clear() noexcept;
  const Fault& fault() const noexcept { return fault_; }

  /// The force for this tick of `dt` seconds. A pose or a force that is no number is a fault at any time;
  /// over-speed and a stale sample are while armed, when force could flow. Without a sample the force is
  /// zero, and ramps up again once there is one. Force and torque are scaled together.
  GuardOutput guard(const GuardInput& input, double dt) noexcept;

 private:
  bool find_fault(const GuardInput& input) noexcept;
  void latch_measured(FaultKind kind, const GuardInput& input, double value, double limit) noexcept;

  GuardLimits limits_;
  bool armed_ = false;
  double ramp_ = 0.0;            // 0 to 1
  glm::dvec3 last_force_{0.0};   // N, of the tick before
  glm::dvec3 last_torque_{0.0};  // N m
  Fault fault_;
  bool cut_ = false;  // by a fault
};

}  // namespace haptic::safety
