#pragma once
// What lies between a hand and the world: how the motion of a device becomes motion in the world, and a force
// in the world one on the hand. It comes before the world sees a sample, so that what is told as the input of
// a tick is what the tick used.
//
//   world = base + scale * (hand - base) + offset          force on the hand = force_scale * force in the
//   world
//
// The offset, and a turn beside it, are zero until a clutch is used: while it is down the device stays where
// it is in the world, and on release it goes on from there, as a mouse that was lifted does. A turn of the
// hand about an axis of the world is one about the same axis there, however the device stands.

#include <cstdint>
#include <optional>

#include "drivers/device.h"
#include "engine/pose.h"

namespace haptic::servo {

struct WorkspaceSettings {
  engine::Pose world_from_base{};  // the device's own frame; its origin is what `scale` leaves in place
  double scale = 1.0;              // > 0
  double force_scale = 1.0;        // > 0
  std::optional<std::uint32_t> clutch_button{};  // 0 to 31
};

/// Servo thread; real-time safe. With the default settings it changes no bit.
class Workspace {
 public:
  explicit Workspace(const WorkspaceSettings& settings) noexcept : settings_(settings) {}

  /// Where the device is in the world when the hand has `sample`; once in each tick. The pose of a sample is
  /// finite, its velocity is scaled with its position and zero while the clutch is down.
  drivers::DeviceSample to_world(const drivers::DeviceSample& sample) noexcept;

  /// A vector of the hand's motion (velocity, acceleration) in the world.
  glm::dvec3 to_world(const glm::dvec3& motion) const noexcept;

  /// What a wrench in the world is on the hand.
  engine::Wrench to_hand(const engine::Wrench& wrench) const noexcept;

  /// A place of the hand (m) in the device's own frame.
  glm::dvec3 to_base(const glm::dvec3& place) const noexcept;

  /// The clutch was down in the last sample.
  bool is_clutched() const noexcept { return clutched_; }

 private:
  engine::Pose place(const drivers::DeviceSample& sample) const noexcept;
  void hold(const drivers::DeviceSample& sample) noexcept;

  WorkspaceSettings settings_;
  bool clutched_ = false;
  bool shifted_ = false;  // the clutch was used: offset_ and turn_ count
  engine::Pose held_{};   // in the world, while the clutch is down
  glm::dvec3 offset_{0.0};
  glm::dquat turn_{1.0, 0.0, 0.0, 0.0};
};

}  // namespace haptic::servo
