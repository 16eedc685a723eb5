#pragma once
// A device under force that tells the very same position for long does not measure any more: a hand trembles,
// and the last bit of an encoder with it. Only for devices that resolve so much.

#include <cstdint>
#include <glm/vec3.hpp>

namespace haptic::safety {

/// Real-time safe.
class StillSample {
 public:
  /// Since the tick before the device was `under_force`, and now tells `position` (m). `tick` ascends.
  void take(std::uint64_t tick, bool under_force, const glm::dvec3& position) noexcept {
    if (!under_force || position != position_) since_ = tick;
    position_ = position;
    still_ = tick - since_;
  }

  /// For so many ticks the position has been the same to the bit, under force all the time.
  std::uint64_t ticks() const noexcept { return still_; }

 private:
  glm::dvec3 position_{0.0};
  std::uint64_t since_ = 0;
  std::uint64_t still_ = 0;
};

}  // namespace haptic::safety
