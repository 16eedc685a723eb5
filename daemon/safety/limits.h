#pragma once
// What a device may do to its user. Three have a say: the config for all devices, the config for this one,
// and the driver, who knows what the hardware bears; of each limit the strictest holds.

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

#include "safety/travel.h"

namespace haptic::safety {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

struct GuardLimits {
  double max_force = 5.0;              // N, magnitude
  double max_force_rate = 500.0;       // N/s, magnitude of the change
  double max_speed = 2.0;              // m/s of the device
  double arm_ramp = 0.5;               // s from none of the force to all of it
  double max_sample_age = 0.02;        // s
  double max_mean_force = kUnlimited;  // N, of the running mean
  double mean_force_time = 10.0;       // s, over which it runs; > 0
  double max_energy = 1.0;             // J given beyond what was taken
  double max_arm_force = 0.5;          // N that may wait when it is armed
  double max_still = kUnlimited;       // s of the very same position under force
  TravelBox travel{};
};

/// What is limited for one device alone; unlimited is no limit beside the others'.
struct DeviceLimits {
  double max_force = kUnlimited;       // N
  double max_force_rate = kUnlimited;  // N/s
  double max_speed = kUnlimited;       // m/s
  double max_mean_force = kUnlimited;  // N
  double max_energy = kUnlimited;      // J
  TravelBox travel{};
};

/// The strictest of both.
inline GuardLimits strictest(GuardLimits limits, const DeviceLimits& own) noexcept {
  limits.max_force = std::min(limits.max_force, own.max_force);
  limits.max_force_rate = std::min(limits.max_force_rate, own.max_force_rate);
  limits.max_speed = std::min(limits.max_speed, own.max_speed);
  limits.max_mean_force = std::min(limits.max_mean_force, own.max_mean_force);
  limits.max_energy = std::min(limits.max_energy, own.max_energy);
  limits.travel = intersection(limits.travel, own.travel);
  return limits;
}

/// Which limits act: bit n is LimitKind n of the schema.
enum Limit : std::uint32_t {
  kLimitNone = 0,
  kLimitForce = 1U << 1U,      // magnitude
  kLimitRate = 1U << 2U,       // slew
  kLimitRamp = 1U << 3U,       // soft start
  kLimitMeanForce = 1U << 4U,  // warm motors
  kLimitClutch = 1U << 5U,     // the clutch is down
};

}  // namespace haptic::safety
