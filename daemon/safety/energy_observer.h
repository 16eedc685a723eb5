#pragma once
// How much work a device has done on its user, beyond what the user has done on it: the passivity observer of
// Hannaford and Ryu (Time-domain passivity control of haptic interfaces, 2002), as a watchdog.
//
//   E = sum of F . dx        E > 0: the device has given energy
//
// dx is the way between two samples, and F the mean of the forces that the hardware held meanwhile. A real
// thing gives no more than it was given; a virtual wall gives more when it is too stiff for its delay, and
// then shakes. So may an object that falls onto the hand, which is why the bound is not zero.
//
// What the user has put in is a credit only up to the same bound: whoever has rubbed a rough wall for a
// minute has put in a lot that no later shaking may use up.

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace haptic::safety {

/// Real-time safe.
class EnergyObserver {
 public:
  /// The bound in J, > 0; infinite for none.
  explicit EnergyObserver(double bound) noexcept : bound_(bound) {}

  /// Since the last call the device was given `force` (N) for `dt` seconds; its newest sample has `position`
  /// (m, same frame) and is of the time `sample_time`, which stays the same until there is another one.
  void take(const glm::dvec3& force, double dt, std::int64_t sample_time,
            const glm::dvec3& position) noexcept {
    if (!placed_) return place(sample_time, position);
    impulse_ += force * dt;
    time_ += dt;
    if (sample_time == sample_time_) return;
    const double given = glm::dot(impulse_ / time_, position - position_);
    energy_ = std::max(-bound_, energy_ + given);
    place(sample_time, position);
  }

  /// The way since the last sample does not count: there was none, or it is of a device that was away.
  void lose_place() noexcept { placed_ = false; }

  /// Counts from zero again.
  void reset() noexcept {
    energy_ = 0.0;
    lose_place();
  }

  /// J given; negative: taken.
  double energy() const noexcept { return energy_; }
  bool is_beyond() const noexcept { return energy_ > bound_; }

 private:
  void place(std::int64_t sample_time, const glm::dvec3& position) noexcept {
    placed_ = true;
    sample_time_ = sample_time;
    position_ = position;
    impulse_ = glm::dvec3(0.0);
    time_ = 0.0;
  }

  double bound_;
  double energy_ = 0.0;
  bool placed_ = false;
  std::int64_t sample_time_ = 0;
  glm::dvec3 position_{0.0};  // of the last sample
  glm::dvec3 impulse_{0.0};   // N s since then
  double time_ = 0.0;         // s since then
};

}  // namespace haptic::safety
