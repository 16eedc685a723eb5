#include "drivers/polhem/polhem_control.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

namespace haptic::drivers::polhem {

namespace {

// the hand may move the arm a little while its counters are set
constexpr int kPresetTolerance = 100;

bool is_near(const Joints& a, const Joints& b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](int left, int right) { return std::abs(left - right) <= kPresetTolerance; });
}

}  // namespace

void PolhemControl::take(const Reading& reading, Nanoseconds now) noexcept {
  if (!settings_.presets_itself) calibration_ = Calibration::kDone;
  const bool is_first = calibration_ == Calibration::kWaiting && settings_.calibrate_at_start;
  if (settings_.presets_itself && (reading.calibrate || is_first)) {
    calibration_ = Calibration::kPresetting;
  } else if (calibration_ == Calibration::kPresetting && is_near(reading.counts, settings_.rest_counts)) {
    calibration_ = Calibration::kDone;
    velocity_.reset();
  }
  if (calibration_ != Calibration::kDone) return sample_.reset();
  angles_ = joint_angles(settings_.model, reading.counts);
  const glm::dvec3 position = tip_position(settings_.model, angles_);
  sample_ = DeviceSample{.time = now, .position = position, .velocity = velocity_.take(now, position)};
}

void PolhemControl::calibrate() noexcept {
  if (!settings_.presets_itself) return;
  calibration_ = Calibration::kPresetting;
  sample_.reset();
}

Message PolhemControl::answer(const ForceCommand& wanted) const noexcept {
  if (calibration_ == Calibration::kPresetting) return preset_message(settings_.rest_counts);
  const double magnitude = glm::length(wanted.force);
  if (!sample_ || !std::isfinite(magnitude) || magnitude == 0.0) return currents_message({});
  const glm::dvec3 force = std::min(1.0, settings_.max_force / magnitude) * wanted.force;
  const glm::dvec3 torques = joint_torques(settings_.model, angles_, force);
  return currents_message(motor_currents(settings_.model, torques, settings_.max_current));
}

}  // namespace haptic::drivers::polhem
