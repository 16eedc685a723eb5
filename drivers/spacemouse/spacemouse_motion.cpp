#include "drivers/spacemouse/spacemouse_motion.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace haptic::drivers::spacemouse {

namespace {

// what passed in a longer gap is not made up: the thread slept
constexpr Nanoseconds kLongestStep = 50'000'000;

glm::dquat rotation_by(const glm::dvec3& turn) noexcept {
  const double angle = glm::length(turn);
  return angle > 0.0 ? glm::angleAxis(angle, turn / angle) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

}  // namespace

void Motion::take(const Decoder& decoder, Nanoseconds now) noexcept {
  deflection_ = {settings_.translation_signs * decoder.deflection().translation,
                 settings_.rotation_signs * decoder.deflection().rotation};
  buttons_ = decoder.buttons();
  last_report_ = now;
}

std::optional<DeviceSample> Motion::advance(Nanoseconds now) noexcept {
  const double dt =
      started_ ? static_cast<double>(std::clamp<Nanoseconds>(now - time_, 0, kLongestStep)) * 1e-9 : 0.0;
  started_ = true;
  time_ = now;
  if (!deflection_.is_zero() && now - last_report_ > kLongestSilence) return std::nullopt;

  const glm::dvec3 reach(settings_.reach);
  const glm::dvec3 before = position_;
  position_ = glm::clamp(position_ + dt * settings_.speed * deflection_.translation, -reach, reach);
  orientation_ = glm::normalize(rotation_by(dt * settings_.turn_rate * deflection_.rotation) * orientation_);
  return DeviceSample{.time = now,
                      .position = position_,
                      .orientation = orientation_,
                      .velocity = dt > 0.0 ? (position_ - before) / dt : glm::dvec3(0.0),
                      .buttons = buttons_};
}

}  // namespace haptic::drivers::spacemouse
