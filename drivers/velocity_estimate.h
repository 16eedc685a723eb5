#pragma once
// Velocity from positions that come at uneven times, smoothed by a first-order lag: differences of encoder
// counts alone would jump by a whole count each millisecond.

#include <cmath>
#include <glm/vec3.hpp>

#include "drivers/device.h"

namespace haptic::drivers {

/// Real-time safe.
class VelocityEstimate {
 public:
  /// `lag` in seconds, > 0.
  explicit VelocityEstimate(double lag) noexcept : lag_(lag) {}

  /// The velocity (m/s) after one more position (m). Zero for the first; a time that does not advance changes
  /// nothing.
  const glm::dvec3& take(Nanoseconds time, const glm::dvec3& position) noexcept {
    if (started_ && time > time_) {
      const double dt = static_cast<double>(time - time_) * 1e-9;
      velocity_ += -std::expm1(-dt / lag_) * ((position - position_) / dt - velocity_);
    }
    if (!started_ || time > time_) {
      time_ = time;
      position_ = position;
    }
    started_ = true;
    return velocity_;
  }

  /// Forgets all: the next position is the first.
  void reset() noexcept { *this = VelocityEstimate(lag_); }

 private:
  double lag_;
  bool started_ = false;
  Nanoseconds time_ = 0;
  glm::dvec3 position_{0.0};
  glm::dvec3 velocity_{0.0};
};

}  // namespace haptic::drivers
