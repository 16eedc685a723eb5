#pragma once
// The last stage before the device, always on: whatever the engine, a scene or a client asks for, what leaves
// here is finite, bounded in magnitude, in rate and in its running mean, and zero unless armed and free of
// faults. Servo thread; real-time safe.
//
//   wanted force -> finite? -> ramp after arming -> warm motors, magnitude -> slew -> device
//                    | no, or over-speed, stale or still sample, over-travel, energy, missed ticks
//                    +-> zero in this very tick, and a latched named fault
//
// A fault cuts: nothing is known any more of what the force should be. Disarming, a clutch, a force that the
// engine stops giving, and a fault of those who drive rather than of what is measured, go to zero by the slew
// limit instead (10 ms at the defaults), so that the hand is not kicked.
//
// All of it is about the hand: where it is and what it feels, whatever a workspace makes of that in the
// world.

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "safety/energy_observer.h"
#include "safety/fault.h"
#include "safety/limits.h"
#include "safety/mean_force.h"
#include "safety/still_sample.h"

namespace haptic::safety {

/// What the guard must know of one device in one tick.
struct GuardInput {
  std::uint64_t tick = 0;
  std::uint32_t device = 0;      // index, for the fault
  bool present = false;          // there is a sample
  double sample_age = 0.0;       // s
  std::int64_t sample_time = 0;  // ns of the servo's clock; the same as before: no new sample
  glm::dvec3 position{0.0};      // m
  glm::dvec3 place{0.0};         // the same in the device's own frame
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 velocity{0.0};  // m/s
  glm::dvec3 force{0.0};     // N wanted
  glm::dvec3 torque{0.0};    // N m wanted
  bool clutched = false;     // no force is wanted, and it ramps up again afterwards
  // of the time since the tick before, in which the hardware held the last force; 0: it has no motors
  double force_share = 1.0;
};

struct GuardOutput {
  glm::dvec3 force{0.0};
  glm::dvec3 torque{0.0};
  std::uint32_t limits = kLimitNone;
};

/// The guard of one device.
class ForceGuard {
 public:
  explicit ForceGuard(const GuardLimits& limits) noexcept;

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
  /// all others are while armed, when force could flow. Without a sample the force is zero, and ramps up
  /// again once there is one. Force and torque are scaled together.
  GuardOutput guard(const GuardInput& input, double dt) noexcept;

  const GuardLimits& limits() const noexcept { return limits_; }
  /// Running mean of what the hardware held, N. It outlives arming and faults, as the warmth does.
  double mean_force() const noexcept { return mean_force_.mean(); }
  /// Given to the user beyond what was taken, since it was armed, J.
  double energy() const noexcept { return energy_.energy(); }

 private:
  void observe(const GuardInput& input, double dt) noexcept;
  bool find_fault(const GuardInput& input, double dt) noexcept;
  void find_fault_of_motion(const GuardInput& input, double dt) noexcept;
  void latch_measured(FaultKind kind, const GuardInput& input, double value, double limit) noexcept;
  GuardOutput let_through(const GuardInput& input, double dt) noexcept;
  double ramp(const GuardInput& input, double dt, std::uint32_t& limits) noexcept;

  GuardLimits limits_;
  MeanForce mean_force_;
  EnergyObserver energy_;
  StillSample still_;
  bool armed_ = false;
  double ramp_ = 0.0;            // 0 to 1
  glm::dvec3 last_force_{0.0};   // N, of the tick before
  glm::dvec3 last_torque_{0.0};  // N m
  Fault fault_;
  bool cut_ = false;  // by a fault
};

}  // namespace haptic::safety
