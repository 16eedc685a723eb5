#include "servo/workspace.h"

namespace haptic::servo {

// where it is but for the clutch
engine::Pose Workspace::place(const drivers::DeviceSample& sample) const noexcept {
  engine::Pose pose{sample.position, sample.orientation};
  if (settings_.scale != 1.0) {
    const glm::dvec3& origin = settings_.world_from_base.position;
    pose.position = origin + settings_.scale * (sample.position - origin);
  }
  if (shifted_) {
    pose.position += offset_;
    // on the right: turns of the hand stay turns about the same axes of the world
    pose.orientation = pose.orientation * turn_;
  }
  return pose;
}

drivers::DeviceSample Workspace::to_world(const drivers::DeviceSample& sample) noexcept {
  const bool down = settings_.clutch_button && ((sample.buttons >> *settings_.clutch_button) & 1U) != 0;
  if (down && !clutched_) held_ = place(sample);
  if (!down && clutched_) hold(sample);
  clutched_ = down;

  const engine::Pose pose = clutched_ ? held_ : place(sample);
  drivers::DeviceSample moved = sample;
  moved.position = pose.position;
  moved.orientation = pose.orientation;
  moved.velocity = to_world(sample.velocity);
  return moved;
}

// from here on `sample` is where the device was held
void Workspace::hold(const drivers::DeviceSample& sample) noexcept {
  shifted_ = false;
  const engine::Pose unshifted = place(sample);
  offset_ = held_.position - unshifted.position;
  turn_ = glm::normalize(glm::conjugate(unshifted.orientation) * held_.orientation);
  shifted_ = true;
}

glm::dvec3 Workspace::to_world(const glm::dvec3& motion) const noexcept {
  if (clutched_) return glm::dvec3(0.0);
  return settings_.scale == 1.0 ? motion : settings_.scale * motion;
}

engine::Wrench Workspace::to_hand(const engine::Wrench& wrench) const noexcept {
  return {settings_.force_scale * wrench.force, settings_.force_scale * wrench.torque};
}

glm::dvec3 Workspace::to_base(const glm::dvec3& place) const noexcept {
  const engine::Pose& base = settings_.world_from_base;
  return glm::conjugate(base.orientation) * (place - base.position);
}

}  // namespace haptic::servo
