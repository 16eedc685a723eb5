#include "drivers/phantom/phantom_control.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptic::drivers::phantom {

namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

}  // namespace

std::uint32_t PhantomControl::raw(const Registers& inputs, std::size_t joint) const noexcept {
  return inputs[settings_.calibration.map.encoders[joint]];
}

void PhantomControl::take(const Registers& inputs, Nanoseconds now) noexcept {
  const Nanoseconds elapsed = now - last_reading_;
  const bool is_first = !has_reading_;
  has_reading_ = true;
  last_reading_ = now;
  const bool is_pressed_now = is_pressed(settings_.calibration.map, inputs);
  if (!has_reference_ && !refer(inputs)) {
    was_released_ = was_released_ || !is_pressed_now;
    hold_ = Hold::kNoReference;
    return;
  }
  if (!advance(inputs, is_first ? kMillisecond : elapsed)) {
    hold_ = Hold::kJump;
    good_readings_ = 0;
    velocity_.reset();
    sample_.reset();
    return;
  }
  if (good_readings_ < kSettlingReadings) {
    ++good_readings_;
    return;
  }
  hold_ = is_believed() ? Hold::kNone : Hold::kOutside;
  const glm::dvec3 position = finger_position(settings_.calibration.geometry, angles_);
  sample_ = DeviceSample{.time = now,
                         .position = position,
                         .velocity = velocity_.take(now, position),
                         .buttons = is_pressed_now ? 1U : 0U};
}

bool PhantomControl::refer(const Registers& inputs) noexcept {
  const Calibration& calibration = settings_.calibration;
  if (calibration.reference == Reference::kRestAtButton &&
      !(was_released_ && is_pressed(calibration.map, inputs))) {
    return false;
  }
  for (std::size_t joint = 0; joint < 3; ++joint) {
    raw_[joint] = raw(inputs, joint);
    const auto rest = static_cast<std::uint32_t>(calibration.rest_counts[joint]);
    counts_[joint] = calibration.reference == Reference::kCountsAreKept
                         ? counted(rest, raw_[joint], calibration.map.encoder_bits[joint])
                         : 0;
  }
  has_reference_ = true;
  return true;
}

bool PhantomControl::advance(const Registers& inputs, Nanoseconds elapsed) noexcept {
  const Calibration& calibration = settings_.calibration;
  const double most = kFastest * static_cast<double>(std::max(elapsed, kMillisecond)) * 1e-9;
  bool is_sound = true;
  for (std::size_t joint = 0; joint < 3; ++joint) {
    const std::uint32_t value = raw(inputs, joint);
    const std::int64_t change = counted(raw_[joint], value, calibration.map.encoder_bits[joint]);
    raw_[joint] = value;
    counts_[joint] += change;
    is_sound =
        is_sound && std::abs(static_cast<double>(change) / calibration.counts_per_radian[joint]) <= most;
    const auto axis = static_cast<glm::length_t>(joint);
    angles_[axis] = calibration.rest_angles[axis] +
                    static_cast<double>(counts_[joint]) / calibration.counts_per_radian[joint];
  }
  return is_sound;
}

bool PhantomControl::is_believed() const noexcept {
  const Calibration& calibration = settings_.calibration;
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    if (!(angles_[axis] >= calibration.least_angles[axis] &&
          angles_[axis] <= calibration.greatest_angles[axis])) {
      return false;
    }
  }
  return true;
}

Hold PhantomControl::hold(Nanoseconds now) const noexcept {
  if (!has_reading_ || now - last_reading_ >= settings_.reading_age) return Hold::kNoReading;
  return hold_;
}

Registers PhantomControl::next_outputs(const ForceCommand& wanted, Nanoseconds now) noexcept {
  const Nanoseconds elapsed = std::clamp<Nanoseconds>(now - last_outputs_, 0, kMillisecond);
  last_outputs_ = now;
  // an expired command has expiry 0: force comes back gently after it too
  const bool may_push = hold(now) == Hold::kNone && now < wanted.expires;
  const double step = static_cast<double>(elapsed) / static_cast<double>(settings_.ramp);
  share_ = may_push ? std::min(1.0, share_ + step) : 0.0;

  const double magnitude = glm::length(wanted.force);
  if (!(share_ > 0.0) || !std::isfinite(magnitude) || magnitude == 0.0) return no_torque();
  const Calibration& calibration = settings_.calibration;
  const double scale = share_ * std::min(1.0, settings_.max_force / magnitude);
  const glm::dvec3 words =
      calibration.words_per_torque * joint_torques(calibration.geometry, angles_, scale * wanted.force);
  return words_for(calibration.map, {words.x, words.y, words.z});
}

}  // namespace haptic::drivers::phantom
