#pragma once
// How fast a device moves, from where it was. Differences of positions that have steps jump by a whole step
// each tick; looking further back smooths them, and comes later. Three ways:
//
//   adaptive window  Per axis, the end points of the longest window on which a straight line meets all
//                    positions within the noise: first-order adaptive windowing of Janabi-Sharifi, Hayward
//                    and Chen (Discrete-time adaptive windowing for velocity estimation, 2000), end-fit.
//                    Long while the device is slow or steady, and short at once when it starts, stops or
//                    jumps. Acceleration is the slope of the velocities in the longest window.
//   low pass         Differences, smoothed by a first-order lag; those of the velocities likewise.
//   driver           The velocity that the sample tells; no acceleration.
//
// Times are those of the samples. One that is told again counts once, and after a gap all begins anew.

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "drivers/device.h"

namespace haptic::servo {

enum class MotionFilterKind : std::uint8_t { kDriver, kAdaptiveWindow, kLowPass };

struct MotionFilterSettings {
  MotionFilterKind kind = MotionFilterKind::kDriver;
  double window = 0.02;  // s, the longest that is looked back
  double noise = 2e-5;   // m that a position may be off, either way
  double cutoff = 40.0;  // Hz, of the low pass
};

/// What was before so long a silence (s) tells nothing about now; trackers tell 30 positions a second.
inline constexpr double kMotionGap = 0.1;
/// Samples closer than this (s) tell no velocity: their times are those of their arrival, and scatter.
inline constexpr double kShortestSpan = 0.0009;

struct Motion {
  glm::dvec3 velocity{0.0};      // m/s
  glm::dvec3 acceleration{0.0};  // m/s^2
};

/// In the frame of the samples.
class MotionFilter {
 public:
  /// Reserves what samples at `rate_hz` need. Not real-time safe.
  MotionFilter(const MotionFilterSettings& settings, double rate_hz);

  /// The motion at the newest sample, which may be the same as before. Real-time safe.
  const Motion& take(const drivers::DeviceSample& sample) noexcept;

 private:
  struct Moment {
    drivers::Nanoseconds time = 0;
    glm::dvec3 position{0.0};
    glm::dvec3 velocity{0.0};
  };

  /// The sample that is `back` samples older than the newest.
  Moment& at(std::size_t back) noexcept;
  void push(const drivers::DeviceSample& sample) noexcept;
  void forget() noexcept;
  void fit_window() noexcept;
  void fit_acceleration() noexcept;
  void smooth() noexcept;

  MotionFilterSettings settings_;
  std::vector<Moment> ring_;
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  Motion motion_;
};

}  // namespace haptic::servo
