#pragma once
// Rigid transforms. A pose named `a_from_b` takes coordinates in frame b to coordinates in frame a, so that
// products read right to left and the names cancel: p_world = world_from_object * p_object.
// SI units, right-handed frames. Everything here is pure and real-time safe.

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace haptic::engine {

/// A rigid transform: rotate by `orientation` (unit quaternion), then shift by `position` (m).
struct Pose {
  glm::dvec3 position{0.0, 0.0, 0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z
};

/// Point of frame b in frame a, given a_from_b.
inline glm::dvec3 operator*(const Pose& a_from_b, const glm::dvec3& p_b) noexcept {
  return a_from_b.position + a_from_b.orientation * p_b;
}

/// a_from_c = a_from_b * b_from_c.
inline Pose operator*(const Pose& a_from_b, const Pose& b_from_c) noexcept {
  return {a_from_b * b_from_c.position, a_from_b.orientation * b_from_c.orientation};
}

/// b_from_a of a_from_b.
inline Pose inverse(const Pose& a_from_b) noexcept {
  const glm::dquat turn = glm::conjugate(a_from_b.orientation);
  return {turn * -a_from_b.position, turn};
}

/// A force and a torque (N, N m) that act together; the point that the torque is about is told where it is
/// used.
struct Wrench {
  glm::dvec3 force{0.0, 0.0, 0.0};
  glm::dvec3 torque{0.0, 0.0, 0.0};
};

}  // namespace haptic::engine
