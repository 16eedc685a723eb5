#pragma once
// The tick, as one sentence: commands, devices, HIPs, world, guard, devices, snapshot. The same tick runs on
// the servo thread of the service and on the virtual clock of `hapticd simulate`.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "drivers/device.h"
#include "safety/force_guard.h"
#include "servo/mailbox.h"

namespace haptic::servo {

/// When a tick runs.
struct Instant {
  std::uint64_t tick = 0;         // servo periods since start; skipped ones count
  drivers::Nanoseconds time = 0;  // the servo's clock at the start of the period
  std::uint64_t missed = 0;       // periods slept through just before this one
  std::uint64_t lateness_ns = 0;  // of the wake-up
};

struct ServoSettings {
  double rate_hz = 1000.0;
  safety::GuardLimits limits;
  std::uint32_t max_missed_ticks = 50;
  bool armed_from_start = false;  // only `simulate`, where no hand is near
  engine::Clock clock = nullptr;  // for stage and transition times; none: nothing is timed
};

class ServoLoop {
 public:
  /// Devices must outlive the loop and be started. The scene is owned from now on.
  ServoLoop(const ServoSettings& settings, std::span<drivers::Device* const> devices,
            std::unique_ptr<PreparedScene> scene, Mailbox& mailbox);
  ~ServoLoop();

  /// One tick. Real-time safe.
  void tick(const Instant& now) noexcept;

  /// For the owner of the thread that ticks: the scene that runs now.
  const PreparedScene& scene() const noexcept { return *scene_; }
};

}  // namespace haptic::servo
