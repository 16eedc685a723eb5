#include "drivers/phantom/phantom_kinematics.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace haptic::drivers::phantom {

namespace {

double reach(const Geometry& geometry, const glm::dvec3& angles) noexcept {
  return geometry.upper_arm * std::cos(angles.y) + geometry.forearm * std::sin(angles.z);
}

}  // namespace

glm::dvec3 finger_position(const Geometry& geometry, const glm::dvec3& angles) noexcept {
  const double r = reach(geometry, angles);
  return {r * std::sin(angles.x),
          geometry.upper_arm * std::sin(angles.y) + geometry.forearm * (1.0 - std::cos(angles.z)),
          r * std::cos(angles.x) - geometry.upper_arm};
}

glm::dvec3 joint_torques(const Geometry& geometry, const glm::dvec3& angles,
                         const glm::dvec3& force) noexcept {
  const double r = reach(geometry, angles);
  const glm::dvec3 outward(std::sin(angles.x), 0.0, std::cos(angles.x));
  const glm::dvec3 to_the_right(std::cos(angles.x), 0.0, -std::sin(angles.x));
  const glm::dvec3 up(0.0, 1.0, 0.0);
  // how the finger moves while one angle grows
  const glm::dvec3 by_base = r * to_the_right;
  const glm::dvec3 by_upper_arm =
      geometry.upper_arm * (std::cos(angles.y) * up - std::sin(angles.y) * outward);
  const glm::dvec3 by_forearm = geometry.forearm * (std::sin(angles.z) * up + std::cos(angles.z) * outward);
  return {glm::dot(by_base, force), glm::dot(by_upper_arm, force), glm::dot(by_forearm, force)};
}

}  // namespace haptic::drivers::phantom
