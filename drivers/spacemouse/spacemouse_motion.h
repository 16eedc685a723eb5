#pragma once
// From how a puck is pushed to where a hand is: deflection is velocity. The frame is that of the puck, cable
// away from the user: x right, y towards the user, z down, and turns about the same axes (not checked on
// hardware; single axes can be inverted, and the base in the config turns the whole).
//
// A puck tells its deflection again and again while it is deflected, and nothing at rest. Silence while it is
// deflected therefore means that it is gone: then there is no pose. Pure; real-time safe.

#include <glm/vec3.hpp>
#include <optional>

#include "drivers/device.h"
#include "drivers/spacemouse/spacemouse_protocol.h"

namespace haptic::drivers::spacemouse {

struct MotionSettings {
  double speed = 0.1;                 // m/s at full deflection
  double turn_rate = 1.0;             // rad/s
  double reach = 0.2;                 // m: no coordinate is further from the start
  glm::dvec3 translation_signs{1.0};  // 1, or -1 for an axis that is inverted
  glm::dvec3 rotation_signs{1.0};
};

/// The longest silence of a puck that is deflected: models send every 8 or 16 ms.
inline constexpr Nanoseconds kLongestSilence = 100'000'000;

class Motion {
 public:
  explicit Motion(const MotionSettings& settings) noexcept : settings_(settings) {}

  /// A report has come.
  void take(const Decoder& decoder, Nanoseconds now) noexcept;

  /// The pose at `now`, moved on since the last call; nothing if the puck fell silent while deflected.
  std::optional<DeviceSample> advance(Nanoseconds now) noexcept;

 private:
  MotionSettings settings_;
  Deflection deflection_;
  std::uint32_t buttons_ = 0;
  Nanoseconds last_report_ = 0;
  bool started_ = false;
  Nanoseconds time_ = 0;
  glm::dvec3 position_{0.0};
  glm::dquat orientation_{1.0, 0.0, 0.0, 0.0};
};

}  // namespace haptic::drivers::spacemouse
