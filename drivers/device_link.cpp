#include "drivers/device_link.h"

#include <cmath>

namespace haptic::drivers {

namespace {

bool is_finite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

bool DeviceLink::read(DeviceSample& sample) noexcept {
  measured_.update();
  if (!measured_.latest().counts) return false;
  const DeviceSample& own = measured_.latest().sample;
  const glm::dquat& turn = world_from_base_.orientation;
  sample = own;
  sample.position = world_from_base_.position + turn * own.position;
  sample.orientation = turn * own.orientation;
  sample.velocity = turn * own.velocity;
  return true;
}

void DeviceLink::write(Nanoseconds now, const ForceCommand& command) noexcept {
  const glm::dquat back = glm::conjugate(world_from_base_.orientation);
  commanded_.write({.command = {.expires = command.expires,
                                .force = back * command.force,
                                .torque = back * command.torque},
                    .written = now});
}

void DeviceLink::publish(const DeviceSample& sample) noexcept {
  measured_.write({.sample = sample, .counts = true});
  if (life_ != nullptr) life_->ready();
}

void DeviceLink::publish_nothing() noexcept { measured_.write({}); }

ForceCommand DeviceLink::live_force(Nanoseconds now) noexcept {
  commanded_.update();
  const Commanded& newest = commanded_.latest();
  const bool is_alive = now < newest.command.expires && now - newest.written < kForceLifetime;
  if (!is_alive || !is_finite(newest.command.force) || !is_finite(newest.command.torque)) return {};
  return newest.command;
}

}  // namespace haptic::drivers
