#pragma once
// What can go wrong with a simulated device, on purpose: its samples are changed on their way to the servo,
// so that a test or a person sees what the guard makes of it. Servo's clock alone; real-time safe once made.

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "drivers/device.h"

namespace haptic::drivers {

enum class InjectedKind : std::uint8_t {
  kDrop,        // no sample
  kDelay,       // the sample of `delay` before, with its old time
  kFreeze,      // the pose of the first one for ever, at rest, with new times
  kNotANumber,  // no number for x
  kJump,        // the position off by `offset`, with the velocity of the jump when it comes and goes
  kUnplug,      // no sample, and no force
};

struct InjectedFault {
  InjectedKind kind = InjectedKind::kDrop;
  double at = 0.0;                                            // s from the first tick
  double duration = std::numeric_limits<double>::infinity();  // s
  double delay = 0.0;                                         // s, 0 to kLongestDelay
  glm::dvec3 offset{0.0};                                     // m, world
};

/// Samples of so long ago are kept, at any rate of the servo (s).
inline constexpr double kLongestDelay = 1.0;

class FaultInjector {
 public:
  explicit FaultInjector(std::span<const InjectedFault> faults);

  /// Forgets all samples.
  void start() noexcept;

  /// What becomes of a sample that was measured at `elapsed` since the first tick. False if it is lost: then
  /// what it holds means nothing. Once in each tick. Real-time safe.
  bool pass(Nanoseconds elapsed, DeviceSample& sample) noexcept;

  /// No force reaches the device, as of the last pass().
  bool is_unplugged() const noexcept { return unplugged_; }

 private:
  struct Active {
    InjectedFault fault;
    bool active = false;        // in the tick before
    DeviceSample frozen{};      // kFreeze
    std::uint64_t delayed = 0;  // kDelay: which of the kept samples shows
  };

  void keep(const DeviceSample& sample) noexcept;
  bool delay(Active& one, bool active, Nanoseconds now, DeviceSample& sample) const noexcept;
  bool change(Active& one, bool active, Nanoseconds now, DeviceSample& sample) const noexcept;

  std::vector<Active> faults_;
  std::vector<DeviceSample> kept_;        // a ring; empty if nothing is ever delayed
  std::uint64_t kept_count_ = 0;          // since the start
  std::optional<Nanoseconds> last_time_;  // of the sample before
  bool unplugged_ = false;
};

}  // namespace haptic::drivers
