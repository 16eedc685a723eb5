#pragma once
// A fault is latched: forces stay zero until a person clears it. (A limit, by contrast, only acts and is
// reported.)

#include <cstdint>

namespace haptic::safety {

enum class FaultKind : std::uint8_t {
  kNone,
  kNotFinite,      // a force or a pose that is no number; value and limit are 0
  kOverSpeed,      // value and limit in m/s
  kStaleSample,    // value and limit in s
  kMissedTicks,    // value and limit in ticks
  kLostDriver,     // value and limit in s of silence; 0: the connection ended
  kOverTravel,     // value: the coordinate in the device's own frame, limit: the side of the box, in m
  kEnergy,         // value and limit in J
  kLostDevice,     // value and limit are 0
  kEmergencyStop,  // value and limit are 0
  kStillSample,    // value and limit in s
};

/// In lower case, e.g. "over_speed"; "none" for no fault.
constexpr const char* name_of(FaultKind kind) noexcept {
  constexpr const char* kNames[] = {"none",         "not_finite",     "over_speed",  "stale_sample",
                                    "missed_ticks", "lost_driver",    "over_travel", "energy",
                                    "lost_device",  "emergency_stop", "still_sample"};
  return kNames[static_cast<int>(kind)];
}

inline constexpr std::uint32_t kNoDevice = 0xffffffff;

struct Fault {
  FaultKind kind = FaultKind::kNone;
  std::uint32_t device = kNoDevice;  // index in the device set; kNoDevice: of the whole daemon
  std::uint64_t tick = 0;
  double value = 0.0;  // what was measured
  double limit = 0.0;  // what is allowed
};

}  // namespace haptic::safety
