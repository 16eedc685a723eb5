#pragma once
// What the driver of an arm decides, without any I/O: a reading and a force in, a sample and the next message
// out. There is neither sample nor force until the counters were preset in the rest pose and have been seen
// to be. Real-time safe.

#include <optional>

#include "drivers/device.h"
#include "drivers/polhem/polhem_kinematics.h"
#include "drivers/polhem/polhem_protocol.h"
#include "drivers/velocity_estimate.h"

namespace haptic::drivers::polhem {

struct ControlSettings {
  Model model = kWoodenhaptics2019;
  Joints rest_counts{};
  bool calibrate_at_start = false;  // otherwise the button tells
  double max_current = 2.0;         // A
  double max_force = 5.0;           // N
  bool presets_itself = true;       // false: nobody can send to the arm, its counts are taken as they are
};

class PolhemControl {
 public:
  explicit PolhemControl(const ControlSettings& settings) noexcept : settings_(settings) {}

  /// What the arm tells at `now`.
  void take(const Reading& reading, Nanoseconds now) noexcept;

  /// The arm is in its rest pose now, as its button tells, too.
  void calibrate() noexcept;

  /// The answer to it: `wanted` is alive, or zero.
  Message answer(const ForceCommand& wanted) const noexcept;

  /// In the arm's frame; nothing unless it is calibrated.
  const std::optional<DeviceSample>& sample() const noexcept { return sample_; }

 private:
  enum class Calibration { kWaiting, kPresetting, kDone };

  ControlSettings settings_;
  Calibration calibration_ = Calibration::kWaiting;
  glm::dvec3 angles_{0.0};
  VelocityEstimate velocity_{0.004};
  std::optional<DeviceSample> sample_;
};

}  // namespace haptic::drivers::polhem
